#include "raytrace/mesh_check.h"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

namespace granrad {

namespace {

using Corner = std::tuple<double, double, double>;

/// How often an edge is passed in the one direction and in the other.
struct Uses {
  std::size_t forward = 0, backward = 0;
};

}  // namespace

MeshCheck check_meshes(const std::vector<Wall>& walls) {
  MeshCheck check;
  std::map<std::pair<Corner, Corner>, Uses> edges;
  for (const Wall& wall : walls)
    for (const auto& t : wall.triangles) {
      ++check.triangles;
      const Vec3 corner[3] = {wall.vertices[static_cast<std::size_t>(t[0])],
                              wall.vertices[static_cast<std::size_t>(t[1])],
                              wall.vertices[static_cast<std::size_t>(t[2])]};
      check.volume_m3 -= dot(corner[0], cross(corner[1], corner[2])) / 6;  // normals point into the void
      for (int c = 0; c < 3; ++c) {
        const Vec3 &a = corner[c], &b = corner[(c + 1) % 3];
        const Corner from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
        ++(from < to ? edges[{from, to}].forward : edges[{to, from}].backward);
      }
    }
  for (const auto& [edge, uses] : edges) {
    if (uses.forward + uses.backward == 1) ++check.open_edges;
    if (uses.forward + uses.backward == 2 && uses.forward != 1) ++check.turned_edges;
  }
  return check;
}

std::string describe(const MeshCheck& check) {
  std::string text = fmt::format("{} triangles, ", check.triangles);
  text +=
      check.open_edges == 0
          ? "closed"
          : fmt::format("not closed ({} open edges: rays that leave there count as open)", check.open_edges);
  if (check.turned_edges > 0)
    return text + fmt::format(
                      ", triangles face opposite sides across {} edges (rays that meet a back leak) "
                      "turn the normals to the particles",
                      check.turned_edges);
  if (check.open_edges > 0) return text;
  return text + (check.volume_m3 > 0 ? ", normals inward"
                                     : ", normals outward (the outside radiates: right for a body among the "
                                       "particles; around them, turn the normals)");
}

}  // namespace granrad
