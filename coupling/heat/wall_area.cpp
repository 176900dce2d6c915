#include "coupling/heat/wall_area.h"

#include <vector>

#include "dem/bed/planar_cut.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

constexpr double same_place = 1e-9;  // of the box

double area_inside(std::vector<Vec3> polygon, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = same_place * norm(box.size());
    Vec3 up{};
    up[axis] = 1;
    polygon = part_above(polygon, -up, -(box.max[axis] + slack));
    polygon = part_above(polygon, up, box.min[axis] - slack);
  }
  return polygon.size() < 3 ? 0 : polygon_area(polygon);
}

}  // namespace

double area_inside(const Wall& wall, const Box& box) {
  double sum = 0;
  for (const auto& face : faces_of(wall)) sum += area_inside(face.vertices, box);
  return sum;
}

}  // namespace granrad
