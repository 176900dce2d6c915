#include "raytrace/exact.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

/// Common area of two discs of radii a >= b whose centres are d apart.
double lens_area(double a, double b, double d) {
  if (d >= a + b) return 0;
  if (d <= a - b) return pi * b * b;
  const double cos_a = std::clamp((d * d + a * a - b * b) / (2 * d * a), -1.0, 1.0);
  const double cos_b = std::clamp((d * d + b * b - a * a) / (2 * d * b), -1.0, 1.0);
  const double doubled_triangle =
      std::sqrt(std::max(0.0, (a + b - d) * (d + a - b) * (d - a + b) * (d + a + b)));
  return a * a * std::acos(cos_a) + b * b * std::acos(cos_b) - 0.5 * doubled_triangle;
}

}  // namespace

double exact_two_sphere(double r1, double r2, double s) {
  const double a = std::max(r1, r2), b = std::min(r1, r2);
  if (a != b) s = std::max(s, a + b);
  // Below theta_in the smaller disc lies whole inside the larger one.
  const double theta_in = std::asin((a - b) / s), theta_out = std::asin(std::min(1.0, (a + b) / s));
  const double half = std::sin(theta_in / 2), whole_part = pi * b * b * 2 * half * half;
  const double width = theta_out - theta_in;
  const auto integrand = [&](double phi) {
    const double theta = theta_in + width * 0.5 * (1 - std::cos(phi));
    return std::sin(theta) * lens_area(a, b, s * std::sin(theta)) * 0.5 * width * std::sin(phi);
  };
  const double lens_part = boost::math::quadrature::gauss<double, 30>::integrate(integrand, 0.0, pi);
  return (whole_part + lens_part) / (2 * pi * r1 * r1);
}

double exact_sphere_wall(const Vec3& centre, const Wall& wall) {
  double solid_angle = 0;
  for (const auto& triangle : triangles_of(wall)) {  // van Oosterom and Strackee 1983
    const Vec3 a = triangle[0] - centre, b = triangle[1] - centre, c = triangle[2] - centre;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double volume = dot(a, cross(b, c));
    const double below = la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la;
    solid_angle -= 2 * std::atan2(volume, below);
  }
  return std::max(0.0, solid_angle / (4 * pi));
}

double exact_parallel_rectangles(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return 2 / (pi * x * y) *
         (std::log(p * q / std::sqrt(1 + x * x + y * y)) + x * q * std::atan(x / q) +
          y * p * std::atan(y / p) - x * std::atan(x) - y * std::atan(y));
}

double exact_perpendicular_rectangles(double length, double from, double to) {
  const double w = from / length, h = to / length, w2 = w * w, h2 = h * h, g2 = w2 + h2, g = std::sqrt(g2);
  const double logs = std::log((1 + w2) * (1 + h2) / (1 + g2)) +
                      w2 * std::log(w2 * (1 + g2) / ((1 + w2) * g2)) +
                      h2 * std::log(h2 * (1 + g2) / ((1 + h2) * g2));
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - g * std::atan(1 / g) + 0.25 * logs) / (pi * w);
}

std::array<std::array<double, 6>, 6> exact_empty_box(const Box& box) {
  std::array<std::array<double, 6>, 6> factor{};
  const Vec3 size = box.size();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const int from = i / 2, to = j / 2, third = 3 - from - to;
      if (i == j) continue;
      if (from == to) {
        factor[i][j] = exact_parallel_rectangles(size[(from + 1) % 3], size[(from + 2) % 3], size[from]);
      } else {  // wall `from` extends along the normal of wall `to`, and the other way round
        factor[i][j] = exact_perpendicular_rectangles(size[third], size[to], size[from]);
      }
    }
  return factor;
}

}  // namespace granrad
