#include "dem/bed/wall_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dem/base/constants.h"

namespace granrad {

namespace {

/// Faces are in one plane when no corner leaves it by more than this part of the wall's size: the rounding of
/// STL files in single precision.
constexpr double planar_tolerance = 1e-6;

Vec3 twice_vector_area(const std::vector<Vec3>& v) {
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < v.size(); ++k) sum += cross(v[k] - v[0], v[k + 1] - v[0]);
  return sum;
}

/// Twice the area of a triangle over its longest side squared: 0 for corners on one line.
double plumpness(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
  return longest > 0 ? norm(cross(b - a, c - a)) / (longest * longest) : 0;
}

bool is_fan(const std::vector<Vec3>& v) {
  for (std::size_t k = 1; k + 1 < v.size(); ++k)
    if (!(plumpness(v[0], v[k], v[k + 1]) > planar_tolerance)) return false;
  return true;
}

}  // namespace

WallFace make_face(std::vector<Vec3> vertices) {
  WallFace face;
  face.normal = polygon_normal(vertices);
  face.bounds = {vertices[0], vertices[0]};
  for (const auto& v : vertices) face.bounds.include(v);
  face.vertices = std::move(vertices);
  return face;
}

std::vector<WallFace> faces_of(const Wall& wall) {
  std::vector<WallFace> faces;
  if (wall.triangles.empty()) faces.push_back(make_face(wall.vertices));
  for (const auto& t : wall.triangles)
    faces.push_back(make_face({wall.vertices[t[0]], wall.vertices[t[1]], wall.vertices[t[2]]}));
  return faces;
}

std::size_t face_count(const Wall& wall) {
  return std::max<std::size_t>(wall.triangles.size(), 1);
}

void set_faces(Wall& wall, const std::vector<WallFace>& faces) {
  wall.vertices.clear();
  wall.triangles.clear();
  if (faces.size() == 1) {
    wall.vertices = faces[0].vertices;
    return;
  }
  std::map<std::tuple<double, double, double>, std::int32_t> known;
  const auto number = [&](const Vec3& p) {
    const auto [at, added] =
        known.try_emplace({p.x, p.y, p.z}, static_cast<std::int32_t>(wall.vertices.size()));
    if (added) wall.vertices.push_back(p);
    return at->second;
  };
  for (const auto& face : faces)
    for (const auto& [a, b, c] : triangulated(face.vertices))
      wall.triangles.push_back({number(a), number(b), number(c)});
}

void flip(Wall& wall) {
  if (wall.triangles.empty())
    std::reverse(wall.vertices.begin(), wall.vertices.end());
  else
    for (auto& t : wall.triangles) std::swap(t[1], t[2]);
}

double polygon_area(const std::vector<Vec3>& vertices) {
  return 0.5 * norm(twice_vector_area(vertices));
}

Vec3 polygon_normal(const std::vector<Vec3>& vertices) {
  return normalized(twice_vector_area(vertices));
}

std::vector<std::array<Vec3, 3>> triangulated(const std::vector<Vec3>& vertices) {
  std::vector<Vec3> left = vertices;
  std::vector<std::array<Vec3, 3>> triangles;
  // Cut off the corner that leaves the least slender triangle, until a fan will do for the rest.
  while (left.size() >= 3) {
    if (is_fan(left)) {
      for (std::size_t k = 1; k + 1 < left.size(); ++k) triangles.push_back({left[0], left[k], left[k + 1]});
      break;
    }
    const std::size_t n = left.size();
    std::size_t best = 0;
    double most = -1;
    for (std::size_t k = 0; k < n; ++k)
      if (const double p = plumpness(left[(k + n - 1) % n], left[k], left[(k + 1) % n]); p > most)
        most = p, best = k;
    if (!(most > planar_tolerance)) break;  // what is left has no area
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return triangles;
}

double area(const Wall& wall) {
  if (wall.triangles.empty()) return polygon_area(wall.vertices);
  double sum = 0;
  for (const auto& t : wall.triangles) {
    const Vec3& a = wall.vertices[t[0]];
    sum += 0.5 * norm(cross(wall.vertices[t[1]] - a, wall.vertices[t[2]] - a));
  }
  return sum;
}

Box bounds_of(const Wall& wall) {
  Box bounds = Box::empty();
  for (const auto& v : wall.vertices) bounds.include(v);
  return bounds;
}

std::optional<WallPlane> plane_of(const Wall& wall) {
  if (wall.triangles.empty()) return WallPlane{wall.vertices[0], polygon_normal(wall.vertices)};
  Vec3 sum;
  double total = 0;
  for (const auto& t : wall.triangles) {
    const Vec3& a = wall.vertices[t[0]];
    const Vec3 doubled = cross(wall.vertices[t[1]] - a, wall.vertices[t[2]] - a);
    sum += doubled;
    total += norm(doubled);
  }
  if (!(norm(sum) >= (1 - planar_tolerance) * total)) return {};
  const WallPlane plane{wall.vertices[wall.triangles[0][0]], normalized(sum)};
  const double slack = planar_tolerance * norm(bounds_of(wall).size());
  for (const auto& v : wall.vertices)
    if (std::abs(plane.height(v)) > slack) return {};
  return plane;
}

std::optional<Parallelogram> parallelogram_of(const Wall& wall) {
  const auto& v = wall.vertices;
  if (!wall.triangles.empty() || v.size() != 4) return {};
  if (!(norm(v[0] - v[1] + v[2] - v[3]) <= 1e-12 * norm(v[2] - v[0]))) return {};
  return Parallelogram{v[0], {v[1] - v[0], v[3] - v[0]}};
}

std::vector<std::array<Vec3, 3>> triangles_of(const Wall& wall) {
  std::vector<std::array<Vec3, 3>> all;
  const auto& v = wall.vertices;
  if (wall.triangles.empty())
    for (std::size_t k = 1; k + 1 < v.size(); ++k) all.push_back({v[0], v[k], v[k + 1]});
  for (const auto& t : wall.triangles) all.push_back({v[t[0]], v[t[1]], v[t[2]]});
  return all;
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
