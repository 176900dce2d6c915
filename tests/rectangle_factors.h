#pragma once
#include <array>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad::rectangles {

/// Interval pairs: [0] and [1] of each rectangle side.
using Side = std::array<double, 2>;

template <class Kernel>
double alternating_sum(const Side& a, const Side& b, const Side& c, const Side& d, Kernel kernel) {
  double sum = 0;
  for (int n = 0; n < 16; ++n) {
    const int i = n & 1, j = n >> 1 & 1, k = n >> 2 & 1, l = n >> 3 & 1;
    sum += ((i + j + k + l) % 2 ? -1 : 1) * kernel(a[i], b[j], c[k], d[l]);
  }
  return sum;
}

/// Exchange area between parallel rectangles x1 x y1 and x2 x y2, a distance z apart (Ehlert and Smith 1993).
inline double parallel(const Side& x1, const Side& y1, const Side& x2, const Side& y2, double z) {
  return alternating_sum(x1, y1, y2, x2, [z](double x, double y, double eta, double xi) {
    const double u = x - xi, v = y - eta, p = std::hypot(u, z), q = std::hypot(v, z);
    return (v * p * std::atan(v / p) + u * q * std::atan(u / q) -
            z * z / 2 * std::log(u * u + v * v + z * z)) /
           (2 * pi);
  });
}

/// Exchange area between perpendicular rectangles: x1 x y1 in the plane z = 0, y2 x z2 in the plane x = 0.
inline double perpendicular(const Side& x1, const Side& y1, const Side& y2, const Side& z2) {
  return alternating_sum(x1, y1, y2, z2, [](double x, double y, double eta, double xi) {
    const double c2 = x * x + xi * xi, c = std::sqrt(c2), v = y - eta, all = c2 + v * v;
    const double atan_part = c > 0 ? v * c * std::atan(v / c) : 0;
    const double log_part = all > 0 ? (c2 - v * v) / 4 * std::log(all) : 0;
    return (atan_part - log_part) / (2 * pi);
  });
}

}  // namespace granrad::rectangles
