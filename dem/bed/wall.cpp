#include "dem/bed/wall.h"

#include <algorithm>

namespace granrad {

double next_opening_s(const std::vector<Wall>& walls, double time_s) {
  double next = infinity;
  for (const auto& w : walls)
    if (stands(w, time_s)) next = std::min(next, w.opens_at_s);
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
