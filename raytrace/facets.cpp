#include "raytrace/facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/planar_cut.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

/// A square of the plane through its foot of the origin, with the given half width.
std::vector<Vec3> large_square(const Vec3& normal, double offset, double half_width) {
  const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(normal, axis)) * half_width, v = cross(normal, u), foot = normal * offset;
  return {foot - u - v, foot + u - v, foot + u + v, foot - u + v};
}

}  // namespace

void Facets::add(const Wall& wall, std::int32_t number, const Vec3& origin, double scale) {
  std::vector<WallFace> faces = faces_of(wall);
  const bool only = faces.size() == 1;
  for (auto& face : faces) {
    for (Vec3& v : face.vertices) v = (v - origin) * scale;
    const bool has_area =
        face.vertices.size() >= 3 && 2 * polygon_area(face.vertices) > tolerance_ * tolerance_;
    if (has_area) {
      add_piece(std::move(face.vertices), number);
      refuse_bent(wall.name, count() - 1);
    } else if (only) {
      throw InputError(
          advised(fmt::format("wall '{}': {} vertices without area", wall.name, face.vertices.size()),
                  "a polygon needs three that are not on a line"));
    }
  }
}

/// Triangles are planar and convex whatever their corners.
void Facets::refuse_bent(const std::string& name, std::int32_t facet) const {
  const auto& corners = vertices(facet);
  if (corners.size() == 3) return;
  double size = 0;
  for (const Vec3& v : corners) size = std::max(size, norm(v - corners[0]));
  for (const Vec3& v : corners) {
    if (std::abs(height(facet, v)) > 1e-6 * size)
      throw InputError(advised(fmt::format("wall '{}': vertices are not in one plane", name),
                               "split it into planar polygons"));
    if (edge_margin(facet, v) < -1e-6 * size)
      throw InputError(advised(fmt::format("wall '{}': not convex", name), "split it into convex polygons"));
  }
}

void Facets::add_piece(std::vector<Vec3> vertices, std::int32_t wall) {
  const Vec3 n = polygon_normal(vertices);
  double offset = 0;
  for (const Vec3& v : vertices) offset += dot(n, v) / static_cast<double>(vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec3 edge = vertices[(k + 1) % vertices.size()] - vertices[k];
    if (norm(edge) <= tolerance_) continue;
    const Vec3 inward = normalized(cross(n, edge));
    edges_.push_back({inward, dot(inward, vertices[k])});
  }
  normal_.push_back(n);
  offset_.push_back(offset);
  area_.push_back(polygon_area(vertices));
  wall_.push_back(wall);
  edge_begin_.push_back(static_cast<std::int32_t>(edges_.size()));
  vertices_.push_back(std::move(vertices));
}

double Facets::edge_margin(std::int32_t facet, const Vec3& p) const {
  double margin = infinity;
  for (std::int32_t e = edge_begin_[facet]; e < edge_begin_[facet + 1]; ++e)
    margin = std::min(margin, dot(edges_[e].inward, p) - edges_[e].offset);
  return margin;
}

double Facets::front_crossing(std::int32_t facet, const Vec3& origin, const Vec3& direction) const {
  const double approach = -dot(normal_[facet], direction);
  if (!(approach > 0)) return infinity;
  const double h = height(facet, origin);
  if (h < -tolerance_) return infinity;
  const double t = std::max(0.0, h / approach);
  return edge_margin(facet, origin + t * direction) >= -tolerance_ ? t : infinity;
}

double Facets::back_crossing(std::int32_t facet, const Vec3& origin, const Vec3& direction) const {
  const double approach = dot(normal_[facet], direction);
  if (!(approach > 0)) return infinity;
  const double h = height(facet, origin);
  if (h >= -tolerance_) return infinity;  // on it: a ray that leaves it at a grazing angle is not behind it
  const double t = -h / approach;
  return edge_margin(facet, origin + t * direction) >= tolerance_ ? t : infinity;
}

/// Integral of x_axis over a facet, times the component of its normal.
double Facets::moment(std::int32_t facet, int axis) const {
  const auto& v = vertices_[facet];
  double sum = 0;
  for (std::size_t k = 2; k < v.size(); ++k) {
    const double area = 0.5 * dot(cross(v[k - 1] - v[0], v[k] - v[0]), normal_[facet]);
    sum += area * (v[0][axis] + v[k - 1][axis] + v[k][axis]) / 3;
  }
  return sum * normal_[facet][axis];
}

std::optional<double> Facets::enclosed_volume(const std::array<bool, 3>& periodic) const {
  double total = 0, volume = 0;
  for (const double a : area_) total += a;
  for (int axis = 0; axis < 3; ++axis) {
    if (periodic[axis]) continue;
    double along = 0;
    volume = 0;
    for (std::int32_t f = 0; f < count(); ++f) {
      along += area_[f] * normal_[f][axis];
      volume -= moment(f, axis);  // normals point into the void
    }
    if (std::abs(along) > 1e-9 * total || !(volume > 0)) return {};
  }
  return volume;
}

std::optional<ConvexCell> ConvexCell::from(const Facets& facets) {
  constexpr std::int32_t most_planes = 64;  // beyond, a tree over the facets is faster than all planes
  if (facets.count() < 4 || facets.count() > most_planes) return {};
  double size = 0;
  for (std::int32_t f = 0; f < facets.count(); ++f)
    for (const Vec3& v : facets.vertices(f)) size = std::max(size, norm(v));
  const double slack = std::max(facets.tolerance(), 1e-9 * size);

  ConvexCell cell;
  for (std::int32_t f = 0; f < facets.count(); ++f) {
    for (std::int32_t g = 0; g < facets.count(); ++g)
      for (const Vec3& v : facets.vertices(g))
        if (facets.height(f, v) < -slack) return {};
    const auto same_plane = [&](const std::vector<std::int32_t>& face) {
      return norm(facets.normal(face[0]) - facets.normal(f)) < 1e-9 &&
             std::abs(facets.offset(face[0]) - facets.offset(f)) < slack;
    };
    const auto face = std::find_if(cell.faces_.begin(), cell.faces_.end(), same_plane);
    if (face == cell.faces_.end())
      cell.faces_.push_back({f});
    else
      face->push_back(f);
  }
  // No hole: the pieces of each plane cover the whole face that the other planes cut out of it.
  for (const auto& face : cell.faces_) {
    std::vector<Vec3> whole = large_square(facets.normal(face[0]), facets.offset(face[0]), 8 * size);
    for (const auto& other : cell.faces_)
      if (&other != &face) whole = part_above(whole, facets.normal(other[0]), facets.offset(other[0]));
    double covered = 0;
    for (const std::int32_t f : face) covered += facets.area(f);
    const double area = whole.size() < 3 ? 0 : polygon_area(whole);
    if (std::abs(covered - area) > 1e-6 * area) return {};
  }
  for (const auto& face : cell.faces_)
    cell.planes_.push_back({facets.normal(face[0]), facets.offset(face[0])});
  return cell;
}

FacetHit ConvexCell::exit(const Facets& facets, const Vec3& origin, const Vec3& direction) const {
  std::size_t nearest = planes_.size(), hidden_by = planes_.size();
  double distance = infinity, deepest = -facets.tolerance();
  for (std::size_t k = 0; k < planes_.size(); ++k) {  // selections, for no branch foresees which plane it is
    const Plane& plane = planes_[k];
    const double h = dot(plane.normal, origin) - plane.offset, approach = -dot(plane.normal, direction);
    const double t = approach > 0 ? h / approach : infinity;
    hidden_by = h < deepest ? k : hidden_by;
    deepest = h < deepest ? h : deepest;
    nearest = t < distance ? k : nearest;
    distance = t < distance ? t : distance;
  }
  distance = std::max(0.0, distance);
  if (hidden_by != planes_.size()) nearest = hidden_by, distance = 0;
  if (nearest == planes_.size()) return {infinity, -1};
  const auto& face = faces_[nearest];
  if (face.size() == 1) return {distance, face[0]};
  const Vec3 p = origin + distance * direction;
  const auto margin_less = [&](std::int32_t a, std::int32_t b) {
    return facets.edge_margin(a, p) < facets.edge_margin(b, p);
  };
  return {distance, *std::max_element(face.begin(), face.end(), margin_less)};
}

}  // namespace granrad
