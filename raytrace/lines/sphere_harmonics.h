#pragma once
#include "dem/base/vec3.h"

namespace granrad {

inline constexpr int highest_harmonic_order = 3;

/// Number of real spherical harmonics up to an order.
constexpr int harmonic_count(int order) {
  return (order + 1) * (order + 1);
}

/// Real spherical harmonics of a unit vector up to `order` <= 3, as polynomials of its components, scaled so
/// that the mean of the square of each over the sphere is 1; the first is 1. value [harmonic_count(order)].
/// (Any table of real spherical harmonics, times sqrt(4 pi).)
inline void sphere_harmonics(int order, const Vec3& n, double* value) {
  const double x = n.x, y = n.y, z = n.z;
  value[0] = 1;
  if (order < 1) return;
  constexpr double c1 = 1.7320508075688772;  // sqrt 3
  value[1] = c1 * y, value[2] = c1 * z, value[3] = c1 * x;
  if (order < 2) return;
  constexpr double c2 = 3.8729833462074170, c20 = 1.1180339887498949;  // sqrt 15, sqrt 5 / 2
  value[4] = c2 * x * y, value[5] = c2 * y * z, value[6] = c20 * (3 * z * z - 1);
  value[7] = c2 * x * z, value[8] = 0.5 * c2 * (x * x - y * y);
  if (order < 3) return;
  constexpr double c33 = 2.0916500663351889, c32 = 10.246950765959598;  // sqrt(35/8), sqrt 105
  constexpr double c31 = 1.6201851746019651, c30 = 1.3228756555322954;  // sqrt(21/8), sqrt 7 / 2
  value[9] = c33 * y * (3 * x * x - y * y), value[10] = c32 * x * y * z;
  value[11] = c31 * y * (5 * z * z - 1), value[12] = c30 * z * (5 * z * z - 3);
  value[13] = c31 * x * (5 * z * z - 1), value[14] = 0.5 * c32 * z * (x * x - y * y);
  value[15] = c33 * x * (x * x - 3 * y * y);
}

}  // namespace granrad
