#include "dem/bed/wall.h"

#include <algorithm>

namespace granrad {

const char* to_string(WallRole role) {
  switch (role) {
    case WallRole::isothermal:
      return "isothermal";
    case WallRole::adiabatic:
      return "adiabatic";
    case WallRole::open:
      return "open";
    case WallRole::excluded:
      return "excluded";
  }
  return "?";
}

namespace {
/// Twice the vector area of a polygon: sum of the cross products of its edges' ends.
Vec3 twice_vector_area(const std::vector<Vec3>& v) {
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < v.size(); ++k) sum += cross(v[k] - v[0], v[k + 1] - v[0]);
  return sum;
}
}  // namespace

double area(const Wall& wall) {
  if (wall.is_polygon()) return 0.5 * norm(twice_vector_area(wall.vertices));
  double sum = 0;
  for (const auto& t : wall.triangles) {
    const Vec3& a = wall.vertices[t[0]];
    sum += 0.5 * norm(cross(wall.vertices[t[1]] - a, wall.vertices[t[2]] - a));
  }
  return sum;
}

Vec3 polygon_normal(const Wall& wall) {
  return normalized(twice_vector_area(wall.vertices));
}

double next_opening_s(const std::vector<Wall>& walls, double time_s) {
  double next = infinity;
  for (const auto& w : walls)
    if (w.contact && w.opens_at_s > time_s) next = std::min(next, w.opens_at_s);
  return next;
}

std::array<Wall, 6> box_walls(const Box& box) {
  static const char* const names[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  std::array<Wall, 6> walls;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool upper = face % 2;
    const auto corner = [&](bool at_u, bool at_v) {
      Vec3 p;
      p[axis] = upper ? box.max[axis] : box.min[axis];
      p[u] = at_u ? box.max[u] : box.min[u];
      p[v] = at_v ? box.max[v] : box.min[v];
      return p;
    };
    Wall& w = walls[face];
    w.name = names[face];
    w.vertices = {corner(false, false), corner(true, false), corner(true, true), corner(false, true)};
    if (upper) std::swap(w.vertices[1], w.vertices[3]);
  }
  return walls;
}

}  // namespace granrad
