#include "dem/bed/wall_distance.h"

#include <algorithm>

#include "dem/base/constants.h"

namespace granrad {

namespace {

WallFace make_face(std::vector<Vec3> vertices) {
  WallFace face;
  Vec3 twice_area;
  for (std::size_t k = 1; k + 1 < vertices.size(); ++k)
    twice_area += cross(vertices[k] - vertices[0], vertices[k + 1] - vertices[0]);
  face.normal = normalized(twice_area);
  face.bounds = Box::empty();
  for (const auto& v : vertices) face.bounds.include(v);
  face.vertices = std::move(vertices);
  return face;
}

}  // namespace

std::vector<WallFace> faces_of(const Wall& wall) {
  std::vector<WallFace> faces;
  if (wall.is_polygon()) faces.push_back(make_face(wall.vertices));
  for (const auto& t : wall.triangles)
    faces.push_back(make_face({wall.vertices[t[0]], wall.vertices[t[1]], wall.vertices[t[2]]}));
  return faces;
}

double distance_to(const WallFace& face, const Vec3& p) {
  const auto& v = face.vertices;
  bool above_interior = true;
  double nearest_squared = infinity;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vec3 edge = v[(k + 1) % v.size()] - v[k], to_p = p - v[k];
    if (dot(cross(face.normal, edge), to_p) >= 0) continue;  // on the inner side of this edge
    above_interior = false;
    const double t = std::clamp(dot(to_p, edge) / dot(edge, edge), 0.0, 1.0);
    const Vec3 gap = to_p - t * edge;
    nearest_squared = std::min(nearest_squared, dot(gap, gap));
  }
  return above_interior ? std::abs(dot(face.normal, p - v[0])) : std::sqrt(nearest_squared);
}

double distance_to(const Wall& wall, const Vec3& p) {
  double nearest = infinity;
  for (const auto& face : faces_of(wall)) nearest = std::min(nearest, distance_to(face, p));
  return nearest;
}

}  // namespace granrad
