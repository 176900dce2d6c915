#include "dem/bed/solid_fraction.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

namespace {

double arc_cosine(double x) {
  return std::acos(std::clamp(x, -1.0, 1.0));
}

double half_chord(double square) {
  return std::sqrt(std::max(0.0, square));
}

/// Angle between the outward normals, on the unit sphere, of the circles {y = b} and {z = c} where they meet.
double turn(double b, double c) {
  return arc_cosine(-b * c / (half_chord(1 - b * b) * half_chord(1 - c * c)));
}

/// Unit sphere, z >= c.
double cap(double c) {
  if (c <= -1) return 4 * pi / 3;
  if (c >= 1) return 0;
  return pi / 3 * (1 - c) * (1 - c) * (2 + c);
}

/// Area of a disc of radius rho beyond the chord at distance b.
double segment(double rho, double b) {
  return rho * rho * arc_cosine(b / rho) - b * half_chord(rho * rho - b * b);
}

/// Unit sphere, y >= b and z >= c.
double wedge(double b, double c) {
  if (b <= -1) return cap(c);
  if (c <= -1) return cap(b);
  if (b < 0) return cap(c) - wedge(-b, c);
  if (c < 0) return cap(b) - wedge(b, -c);
  if (b * b + c * c >= 1) return 0;
  const double rho_b = half_chord(1 - b * b), rho_c = half_chord(1 - c * c);
  const double area = 2 * pi - 2 * (b * arc_cosine(c / rho_b) + c * arc_cosine(b / rho_c)) - 2 * turn(b, c);
  return (area - b * segment(rho_b, c) - c * segment(rho_c, b)) / 3;
}

/// Part of a disc of radius rho beyond y = b and z = c, with the angle of its arc; b^2 + c^2 < rho^2.
struct Quadrant {
  double area, angle;
};
Quadrant quadrant(double rho, double b, double c) {
  const double angle = arc_cosine(b / rho) - std::asin(std::clamp(c / rho, -1.0, 1.0));
  const double along_b = half_chord(rho * rho - b * b) - c, along_c = half_chord(rho * rho - c * c) - b;
  return {0.5 * (rho * rho * angle - b * along_b - c * along_c), angle};
}

/// Unit sphere, x >= a, y >= b and z >= c.
double octant(double a, double b, double c) {
  if (a <= -1) return wedge(b, c);
  if (b <= -1) return wedge(a, c);
  if (c <= -1) return wedge(a, b);
  if (a < 0) return wedge(b, c) - octant(-a, b, c);
  if (b < 0) return wedge(a, c) - octant(a, -b, c);
  if (c < 0) return wedge(a, b) - octant(a, b, -c);
  if (a * a + b * b + c * c >= 1) return 0;
  const Quadrant at_a = quadrant(half_chord(1 - a * a), b, c), at_b = quadrant(half_chord(1 - b * b), c, a),
                 at_c = quadrant(half_chord(1 - c * c), a, b);
  const double area =
      2 * pi - a * at_a.angle - b * at_b.angle - c * at_c.angle - turn(b, c) - turn(c, a) - turn(a, b);
  return (area - a * at_a.area - b * at_b.area - c * at_c.area) / 3;
}

/// What a sphere and its images along the periodic axes from `axis` on have inside the region.
double volume_with_images(Vec3 centre, double radius, const Box& region, const std::array<bool, 3>& periodic,
                          const Vec3& period, int axis = 0) {
  while (axis < 3 && !periodic[axis]) ++axis;
  if (axis == 3) return sphere_volume_in_box_m3(centre, radius, region);
  double sum = 0;
  const double step = period[axis];
  centre[axis] += std::ceil((region.min[axis] - radius - centre[axis]) / step) * step;
  for (; centre[axis] - radius < region.max[axis]; centre[axis] += step)
    sum += volume_with_images(centre, radius, region, periodic, period, axis + 1);
  return sum;
}

}  // namespace

double sphere_volume_in_box_m3(const Vec3& centre_m, double radius_m, const Box& box) {
  if (!(radius_m > 0)) return 0;
  const double r = radius_m;
  const Vec3 low = (box.min - centre_m) * (1 / r), high = (box.max - centre_m) * (1 / r);
  bool whole = true;
  for (int k = 0; k < 3; ++k) {
    if (low[k] >= 1 || high[k] <= -1 || !(high[k] > low[k])) return 0;
    whole = whole && low[k] <= -1 && high[k] >= 1;
  }
  if (whole) return sphere_volume(r);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at{(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                  (corner & 4) != 0 ? high.z : low.z};
    if (at.x >= 1 || at.y >= 1 || at.z >= 1) continue;
    const bool odd = ((corner ^ (corner >> 1) ^ (corner >> 2)) & 1) != 0;
    sum += (odd ? -1 : 1) * octant(at.x, at.y, at.z);
  }
  return std::max(0.0, sum) * r * r * r;
}

double solid_fraction(const std::vector<Vec3>& centre_m, const std::vector<double>& radius_m,
                      const Box& region, const std::array<bool, 3>& periodic, const Box& period) {
  if (!(region.volume() > 0)) return 0;
  double solid = 0;
  for (std::size_t i = 0; i < centre_m.size(); ++i)
    solid += volume_with_images(centre_m[i], radius_m[i], region, periodic, period.size());
  return solid / region.volume();
}

double solid_fraction(const Bed& bed, const Box& region) {
  return solid_fraction(bed.position_m, bed.radius_m, region, bed.periodic, bed.box);
}

}  // namespace granrad
