// Requirement: the heat between black plates through a thin cloud of black spheres in radiative equilibrium is that of
// Heaslet and Warming (Int. J. Heat Mass Transfer 8 (1965) 979), to solid fraction 0.
#include <gtest/gtest.h>

#include <boost/math/special_functions/expint.hpp>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/packing/packing.h"
#include "raytrace/slab/slab.h"
#include "tests/record.h"

using namespace granrad;

namespace {

double expint(unsigned n, double x) {
  return x > 0 ? boost::math::expint(n, x) : n > 1 ? 1.0 / (n - 1) : 0.0;
}

/// phi(x) = 1/2 E2(x) + 1/2 int_0^L phi(t) E1|x - t| dt by Gauss-Seidel on hat functions, whose kernel integrals are
/// exact by E2 and E3; nodes crowd at the plates. q = 1 - 2 int phi(t) E2(t) dt by Simpson's rule in each piece.
double exact_flux(double depth, int n) {
  std::vector<double> x(n + 1), phi(n + 1), right(n + 1);
  for (int k = 0; k <= n; ++k) {
    const double s = static_cast<double>(k) / n;
    x[k] = depth * s * s * (3 - 2 * s);
    phi[k] = 1 - (x[k] + 0.5) / (depth + 1);
    right[k] = 0.5 * expint(2, x[k]);
  }
  std::vector<double> kernel((n + 1) * (n + 1), 0.0);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < n; ++j) {
      const double h = x[j + 1] - x[j], near = x[i] <= x[j] ? x[j] - x[i] : x[i] - x[j + 1], far = near + h;
      const double whole = expint(2, near) - expint(2, far);
      const double moment = near * expint(2, near) + expint(3, near) - far * expint(2, far) - expint(3, far);
      const double from_near = moment - near * whole;  // int of (distance - near) E1
      const double to_right = x[i] <= x[j] ? from_near : h * whole - from_near;
      kernel[i * (n + 1) + j] += 0.5 * (whole - to_right / h);
      kernel[i * (n + 1) + j + 1] += 0.5 * to_right / h;
    }
  for (int sweep = 0; sweep < 4000; ++sweep) {
    double change = 0;
    for (int i = 0; i <= n; ++i) {
      double sum = right[i];
      for (int j = 0; j <= n; ++j)
        if (j != i) sum += kernel[i * (n + 1) + j] * phi[j];
      const double next = sum / (1 - kernel[i * (n + 1) + i]);
      change = std::max(change, std::abs(next - phi[i]));
      phi[i] = next;
    }
    if (change < 1e-13) break;
  }
  double q = 1;
  for (int j = 0; j < n; ++j) {
    const double h = x[j + 1] - x[j];
    q -= 2 * h / 6 *
         (phi[j] * expint(2, x[j]) + 4 * 0.5 * (phi[j] + phi[j + 1]) * expint(2, x[j] + h / 2) +
          phi[j + 1] * expint(2, x[j + 1]));
  }
  return q;
}

/// 700 black spheres of diameter 1 between black plates, N pi r^2 / A = depth, periodic at the sides.
Slab cloud(double depth, double solid_fraction, std::uint64_t seed) {
  const double n = 700, side = std::sqrt(n * pi / 4 / depth),
               length = n * pi / 6 / (solid_fraction * side * side);
  Enclosure e;
  e.box = {{0, 0, 0}, {side, side, length}};
  e.periodic = {true, true, false};
  PackingRequest request;
  request.where = {e.box, e.periodic};
  request.radius_m.assign(700, 0.5);
  request.seed = seed;
  e.centre_m = pack_spheres(request);
  e.radius_m = request.radius_m;
  for (std::int32_t k = 0; k < 700; ++k) e.particle.push_back(k);
  const auto walls = box_walls(e.box);
  for (int side_number : {4, 5}) {
    e.walls.push_back(walls[side_number]);
    e.wall.push_back(side_number);
  }
  return make_slab(e, 2);
}

}  // namespace

TEST(ThinCloud, TheExactFluxIsThatOfTheTables) {
  const double depth[] = {0.1, 0.5, 1, 2, 3}, flux[] = {0.91570, 0.70417, 0.55341, 0.39006, 0.30164};
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(exact_flux(depth[k], 120), flux[k], 2e-5) << depth[k];
}

// Checks emission, tracing, periods, closure and the solution together, to 0.2 % and two errors of the mean over
// the beds. Planted, seen: directions uniform over the hemisphere (6.7 % low).
TEST(ThinCloud, TracedCloudsTendToItLong) {
  for (const double depth : {0.5, 1.0}) {
    double extrapolated = 0, squares = 0;
    const int beds = 8;
    for (int b = 0; b < beds; ++b) {
      double flux[2];
      for (int k = 0; k < 2; ++k) {
        const Slab slab = cloud(depth, k == 0 ? 0.04 : 0.01, 10 + static_cast<std::uint64_t>(b));
        const std::vector<double> black(slab.enclosure.surface_count(), 1.0);
        flux[k] = measure_exchange_factor(slab, black, {.rays_per_particle = 2000}, 2).flux.value;
      }
      const double limit = (4 * flux[1] - flux[0]) / 3;  // linear in solid fraction
      extrapolated += limit / beds;
      squares += limit * limit / beds;
    }
    const double error = std::sqrt((squares - extrapolated * extrapolated) / (beds - 1));
    const double exact = exact_flux(depth, 120);
    EXPECT_NEAR(extrapolated, exact, 0.002 * exact + 2 * error) << depth;
    EXPECT_LT(error, 0.002 * exact) << "the beds are many enough";
    record("thin_cloud_over_exact", extrapolated / exact, error / exact);
  }
}
