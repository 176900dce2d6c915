#include "dem/liggghts/wall_meshes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "dem/base/constants.h"
#include "dem/bed/planar_cut.h"
#include "dem/bed/wall_shape.h"

namespace granrad::liggghts {

namespace {

/// The part of a convex polygon where sign x coordinate <= sign x limit; what is cut ends on the limit.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, int axis, double limit, double sign) {
  constexpr double rounding = 1e-12;  // of the coordinates
  Vec3 inward{};
  inward[axis] = -sign;
  auto kept = part_above(polygon, inward, -sign * limit);
  for (auto& v : kept)
    if (std::abs(v[axis] - limit) <= rounding * (std::abs(limit) + norm(v))) v[axis] = limit;
  return kept;
}

std::vector<Vec3> inside_periods(std::vector<Vec3> polygon, const Bed& bed) {
  for (int a = 0; a < 3; ++a)
    if (bed.periodic[a]) polygon = cut(cut(polygon, a, bed.box.min[a], -1), a, bed.box.max[a], 1);
  return polygon;
}

}  // namespace

WallMeshes::WallMeshes(const Bed& bed) {
  std::set<std::vector<std::array<double, 3>>> known;  // the other side of a plate is the same face
  for (const auto& wall : bed.walls) {
    const bool standing = stands(wall, bed.time_s);
    for (const auto& face : faces_of(wall)) {
      const auto number = static_cast<std::int64_t>(first_.size());
      first_.push_back({0, -1});
      const auto corners = inside_periods(face.vertices, bed);
      if (!standing || corners.size() < 3) continue;
      std::vector<std::array<double, 3>> outline;
      for (const Vec3& v : corners) outline.push_back({v.x, v.y, v.z});
      std::sort(outline.begin(), outline.end());
      if (known.insert(std::move(outline)).second) add(wall, corners, number);
    }
  }
}

void WallMeshes::add(const Wall& wall, const std::vector<Vec3>& corners, std::int64_t face) {
  auto mesh = std::find_if(meshes_.begin(), meshes_.end(),
                           [&](const WallMesh& m) { return m.velocity_m_s == wall.velocity_m_s; });
  if (mesh == meshes_.end()) {
    mesh = meshes_.insert(mesh, {wall.velocity_m_s, {}});
    face_.emplace_back();
  }
  const auto number = static_cast<std::size_t>(mesh - meshes_.begin());
  first_[face] = {number, static_cast<std::int32_t>(mesh->triangles.size())};
  for (const auto& triangle : triangulated(corners)) {
    mesh->triangles.push_back(triangle);
    face_[number].push_back(face);
  }
}

WallMeshes::Place WallMeshes::nearest(std::int64_t face, const Vec3& p) const {
  if (face < 0 || face >= static_cast<std::int64_t>(first_.size()) || first_[face].triangle < 0)
    return {0, -1};
  Place best = first_[face];
  const auto& faces = face_[best.mesh];
  double least = infinity;
  for (auto t = static_cast<std::size_t>(best.triangle); t < faces.size() && faces[t] == face; ++t) {
    const auto& corners = meshes_[best.mesh].triangles[t];
    const double distance = distance_to(make_face({corners.begin(), corners.end()}), p);
    if (distance < least) least = distance, best.triangle = static_cast<std::int32_t>(t);
  }
  return best;
}

}  // namespace granrad::liggghts
