#include "raytrace/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "dem/bed/wall_shape.h"

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

bool has_two_sides(const Wall& wall) {
  constexpr double same = 1e-6;
  const std::vector<WallFace> faces = faces_of(wall);
  double size = 0;
  for (const Vec3& v : wall.vertices) size = std::max(size, norm(v - wall.vertices[0]));
  // By the plane, told by its distance from a corner and whichever normal: faces that look opposite ways lie together.
  std::multimap<double, const WallFace*> by_distance;
  for (const WallFace& face : faces)
    by_distance.emplace(std::abs(dot(face.vertices[0] - wall.vertices[0], face.normal)), &face);
  // Triangles of the two sides may be cut along opposite diagonals: their middles then lie on edges of the other.
  const auto inside = [&](const Vec3& p, const WallFace& face) {
    for (std::size_t k = 0; k < face.vertices.size(); ++k) {
      const Vec3 edge = face.vertices[(k + 1) % face.vertices.size()] - face.vertices[k];
      if (dot(cross(face.normal, edge), p - face.vertices[k]) < -same * size * norm(edge)) return false;
    }
    return true;
  };
  for (const auto& [distance, face] : by_distance) {
    Vec3 middle{};
    for (const Vec3& v : face->vertices) middle += v * (1.0 / static_cast<double>(face->vertices.size()));
    for (auto other = by_distance.lower_bound(distance - same * size);
         other != by_distance.end() && other->first <= distance + same * size; ++other) {
      const WallFace& back = *other->second;
      if (dot(face->normal, back.normal) < -1 + same &&
          std::abs(dot(middle - back.vertices[0], back.normal)) < same * size && inside(middle, back))
        return true;
    }
  }
  return false;
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
