// Requirement: the spherical harmonics are orthogonal with a mean square of 1 over the sphere, and each is of
// its order: the mean over a rotation about z of what a reflection sees stays in the order.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "raytrace/lines/sphere_harmonics.h"

namespace granrad {
namespace {

/// Product rule that is exact for polynomials of degree 6: Gauss-Legendre in z, even spacing in azimuth.
template <class Function>
double sphere_mean(Function f) {
  const double z[4] = {0.8611363115940526, 0.3399810435848563, -0.3399810435848563, -0.8611363115940526};
  const double weight[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  double sum = 0;
  for (int a = 0; a < 4; ++a)
    for (int k = 0; k < 9; ++k) {
      const double phi = 2 * pi * k / 9, s = std::sqrt(1 - z[a] * z[a]);
      sum += weight[a] / 2 / 9 * f(Vec3{s * std::cos(phi), s * std::sin(phi), z[a]});
    }
  return sum;
}

TEST(SphereHarmonics, AreOrthonormal) {
  const int n = harmonic_count(3);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const double product = sphere_mean([&](const Vec3& v) {
        double y[16];
        sphere_harmonics(3, v, y);
        return y[a] * y[b];
      });
      EXPECT_NEAR(product, a == b, 1e-13) << a << " " << b;
    }
}

/// Addition theorem: sum over an order of Y(n) Y(m) = (2 l + 1) P_l(n . m).
TEST(SphereHarmonics, ObeyTheAdditionTheorem) {
  const Vec3 n = normalized(Vec3{1, 2, -0.5}), m = normalized(Vec3{-0.3, 0.4, 1});
  double y[16], w[16];
  sphere_harmonics(3, n, y), sphere_harmonics(3, m, w);
  const double c = dot(n, m);
  const double legendre[4] = {1, c, 1.5 * c * c - 0.5, 2.5 * c * c * c - 1.5 * c};
  for (int l = 0, k = 0; l <= 3; ++l) {
    double sum = 0;
    for (; k < harmonic_count(l); ++k) sum += y[k] * w[k];
    EXPECT_NEAR(sum, (2 * l + 1) * legendre[l], 1e-13) << l;
  }
}

}  // namespace
}  // namespace granrad
