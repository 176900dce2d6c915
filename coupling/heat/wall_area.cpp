#include "coupling/heat/wall_area.h"

#include <vector>

#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

constexpr double same_place = 1e-9;  // of the box

/// The part of a convex polygon with side * (v[axis] - at) <= 0.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, int axis, double at, double side) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double out_a = side * (a[axis] - at), out_b = side * (b[axis] - at);
    if (out_a <= 0) kept.push_back(a);
    if ((out_a < 0 && out_b > 0) || (out_a > 0 && out_b < 0))
      kept.push_back(a + (b - a) * (out_a / (out_a - out_b)));
  }
  return kept;
}

double area_of(const std::vector<Vec3>& polygon) {
  Vec3 sum{};
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  return 0.5 * norm(sum);
}

double area_inside(std::vector<Vec3> polygon, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = same_place * norm(box.size());
    polygon = clipped(polygon, axis, box.max[axis] + slack, 1);
    polygon = clipped(polygon, axis, box.min[axis] - slack, -1);
  }
  return area_of(polygon);
}

}  // namespace

double area_inside(const Wall& wall, const Box& box) {
  double sum = 0;
  for (const auto& face : faces_of(wall)) sum += area_inside(face.vertices, box);
  return sum;
}

}  // namespace granrad
