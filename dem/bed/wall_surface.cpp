#include "dem/bed/wall_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dem/base/constants.h"
#include "dem/bed/planar_cut.h"
#include "dem/bed/wall_shape.h"

namespace granrad {
namespace {

/// Facets count as coplanar when their corners leave the common plane by less than this fraction of their
/// size: the rounding of STL files in single precision.
constexpr double coplanar_tolerance = 1e-6;

double distance_to_segment(const Vec3& p, const Vec3& start, const Vec3& direction, double length) {
  const double t = std::clamp(dot(p - start, direction), 0.0, length);
  return norm(p - start - direction * t);
}

}  // namespace

WallSurface::WallSurface(const std::vector<Wall>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    for (const auto& face : faces_of(walls[w])) add_facet(static_cast<std::int32_t>(w), face.vertices);
  }
  std::map<std::tuple<double, double, double>, std::int32_t> number_of;
  std::vector<Vec3> welded;
  std::vector<std::int32_t> new_number;
  for (const auto& v : vertices_) {
    const auto [at, added] = number_of.try_emplace({v.x, v.y, v.z}, static_cast<std::int32_t>(welded.size()));
    if (added) welded.push_back(v);
    new_number.push_back(at->second);
  }
  vertices_ = std::move(welded);
  for (auto& f : facets_)
    for (auto& c : f.corners) c = new_number[c];
  find_twins(walls);
  split_sides();
  join_sides();
  group_coplanar(walls);
  fill_rows(walls);
}

void WallSurface::add_facet(std::int32_t wall, const std::vector<Vec3>& corners) {
  Facet f;
  f.wall = wall;
  f.group = facet_count();
  f.point = corners[0];
  f.normal = polygon_normal(corners);
  if (!is_finite(f.normal)) {  // a triangle without area
    whole_ = false;
    return;
  }
  f.bounds = {corners[0], corners[0]};
  for (const auto& c : corners) {
    f.bounds.include(c);
    f.corners.push_back(static_cast<std::int32_t>(vertices_.size()));
    vertices_.push_back(c);
  }
  facets_.push_back(std::move(f));
}

/// Facets with the same corners whose walls touch and open alike: the first stands for all.
void WallSurface::find_twins(const std::vector<Wall>& walls) {
  std::map<std::vector<std::int32_t>, std::vector<std::int32_t>> known;
  for (std::int32_t n = 0; n < facet_count(); ++n) {
    auto corners = facets_[n].corners;
    std::sort(corners.begin(), corners.end());
    auto& same = known[std::move(corners)];
    for (const auto m : same) {
      const Wall &v = walls[facets_[m].wall], &w = walls[facets_[n].wall];
      if (v.contact != w.contact || v.opens_at_s != w.opens_at_s) continue;
      facets_[n].twin = true;
      if (dot(facets_[n].normal, facets_[m].normal) < 0) facets_[m].back = n;
      break;
    }
    if (!facets_[n].twin) same.push_back(n);
  }
}

/// Corners of a coplanar facet that lie inside a side divide it, so that the two share edges.
void WallSurface::split_sides() {
  Box all = Box::empty();
  for (const auto& v : vertices_) all.include(v);
  if (all.is_empty()) return;
  const double slack_m = coplanar_tolerance * norm(all.size());
  std::map<std::tuple<double, double, double>, std::int32_t> number_of;
  CornerSet corners(slack_m);
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    number_of.emplace(std::tuple(vertices_[v].x, vertices_[v].y, vertices_[v].z),
                      static_cast<std::int32_t>(v));
  std::vector<std::vector<std::int32_t>> facets_at(vertices_.size());
  for (std::int32_t n = 0; n < facet_count(); ++n)
    for (const auto c : facets_[n].corners) facets_at[c].push_back(n);
  for (const auto& v : vertices_) corners.keep(v);
  corners.sort();
  for (auto& f : facets_) {
    std::vector<Vec3> outline;
    for (const auto c : f.corners) outline.push_back(vertices_[c]);
    const auto is_of_coplanar = [&](const Vec3& p) {
      const auto& around = facets_at[number_of.at({p.x, p.y, p.z})];
      return std::any_of(around.begin(), around.end(),
                         [&](std::int32_t g) { return coplanar(f, facets_[g]); });
    };
    if (!corners.insert_into(outline, is_of_coplanar)) continue;
    f.corners.clear();
    for (const auto& p : outline) f.corners.push_back(number_of.at({p.x, p.y, p.z}));
  }
}

void WallSurface::join_sides() {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> edge_between;
  edges_of_vertex_.resize(vertices_.size());
  for (std::int32_t n = 0; n < facet_count(); ++n) {
    Facet& f = facets_[n];
    for (std::size_t k = 0; k < f.corners.size(); ++k) {
      const auto a = f.corners[k], b = f.corners[(k + 1) % f.corners.size()];
      const auto ends = std::minmax(a, b);
      const auto [at, added] = edge_between.try_emplace(ends, static_cast<std::int32_t>(edges_.size()));
      if (added) {
        const Vec3 start = vertices_[ends.first], along = vertices_[ends.second] - start;
        edges_.push_back({{ends.first, ends.second}, start, normalized(along), norm(along), {}});
        edges_of_vertex_[a].push_back(at->second);
        edges_of_vertex_[b].push_back(at->second);
      }
      if (!f.twin) edges_[at->second].facets.push_back(n);
      f.sides.push_back({at->second, normalized(cross(f.normal, vertices_[b] - vertices_[a]))});
    }
  }
}

bool WallSurface::coplanar(const Facet& a, const Facet& b) const {
  const double size = std::max(norm(a.bounds.size()), norm(b.bounds.size()));
  if (std::abs(dot(a.normal, b.normal)) < 0.9) return false;
  for (const auto c : b.corners)
    if (std::abs(dot(vertices_[c] - a.point, a.normal)) > coplanar_tolerance * size) return false;
  return true;
}

/// Groups grow over edges with exactly two facets that lie on both sides of it in the plane of the group's
/// first facet, if both move and open alike.
void WallSurface::group_coplanar(const std::vector<Wall>& walls) {
  const auto alike = [&](const Facet& a, const Facet& b) {
    const Wall &v = walls[a.wall], &w = walls[b.wall];
    return v.velocity_m_s == w.velocity_m_s && v.opens_at_s == w.opens_at_s && v.contact == w.contact;
  };
  for (std::int32_t n = 0; n < facet_count(); ++n) {
    if (facets_[n].group != n || facets_[n].twin) continue;
    std::vector<std::int32_t> front{n};
    while (!front.empty()) {
      const auto at = front.back();
      front.pop_back();
      for (auto& side : facets_[at].sides) {
        const auto& around = edges_[side.edge].facets;
        if (around.size() != 2 || side.smooth) continue;
        const auto other = around[0] == at ? around[1] : around[0];
        if (other == at || !alike(facets_[n], facets_[other]) || !coplanar(facets_[n], facets_[other]))
          continue;
        Side& opposite = side_of(other, side.edge);
        if (dot(side.inward, opposite.inward) > 0) continue;
        if (facets_[other].group != n && facets_[other].group != other) continue;
        side.smooth = opposite.smooth = true;
        opposite.inward = Vec3{} - side.inward;
        if (facets_[other].group != n && other > n) facets_[other].group = n, front.push_back(other);
      }
    }
  }
  vertex_is_flat_.assign(vertices_.size(), true);
  std::vector<std::int32_t> group_at(vertices_.size(), -1);
  for (const auto& f : facets_)
    for (std::size_t k = 0; k < f.corners.size() && !f.twin; ++k) {
      const auto c = f.corners[k];
      if (group_at[c] >= 0 && group_at[c] != f.group) vertex_is_flat_[c] = false;
      group_at[c] = f.group;
      const auto& before = f.sides[(k + f.sides.size() - 1) % f.sides.size()];
      if (!f.sides[k].smooth || !before.smooth) vertex_is_flat_[c] = false;
    }
}

void WallSurface::fill_rows(const std::vector<Wall>& walls) {
  for (const auto& f : facets_) {
    const Facet& plane = facets_[f.group];
    for (const double x : {plane.point.x, plane.point.y, plane.point.z, 0.0, plane.normal.x, plane.normal.y,
                           plane.normal.z, 0.0})
      plane_rows_.push_back(x);
    const Vec3& given = walls[f.wall].velocity_m_s;
    const Vec3 v = given - f.normal * dot(given, f.normal);  // a surface slides, it does not move
    for (const double x : {v.x, v.y, v.z, 0.0}) velocity_rows_.push_back(x);
  }
  for (const double x : {1e9, 1e9, 1e9, 0.0, 1.0, 0.0, 0.0, 0.0}) plane_rows_.push_back(x);
  velocity_rows_.insert(velocity_rows_.end(), 4, 0.0);
}

void WallSurface::set_time(const std::vector<Wall>& walls, double time_s) {
  for (auto& f : facets_) f.stands = !f.twin && granrad::stands(walls[f.wall], time_s);
}

WallSurface::Side& WallSurface::side_of(std::int32_t facet, std::int32_t edge) {
  auto& sides = facets_[facet].sides;
  return *std::find_if(sides.begin(), sides.end(), [&](const Side& side) { return side.edge == edge; });
}

const WallSurface::Side& WallSurface::side_of(std::int32_t facet, std::int32_t edge) const {
  const auto& sides = facets_[facet].sides;
  return *std::find_if(sides.begin(), sides.end(), [&](const Side& side) { return side.edge == edge; });
}

double WallSurface::height(std::int32_t f, const Vec3& p) const {
  const Facet& plane = facets_[facets_[f].group];
  return dot(p - plane.point, plane.normal);
}

bool WallSurface::foot_inside(std::int32_t f, const Vec3& p) const {
  return std::all_of(facets_[f].sides.begin(), facets_[f].sides.end(),
                     [&](const Side& side) { return inside_by(side, p) > 0; });
}

double WallSurface::distance(std::int32_t f, const Vec3& p) const {
  if (foot_inside(f, p)) return std::abs(height(f, p));
  double nearest = infinity;
  for (const auto& side : facets_[f].sides) {
    const Edge& e = edges_[side.edge];
    nearest = std::min(nearest, distance_to_segment(p, e.start, e.direction, e.length));
  }
  return nearest;
}

bool WallSurface::clear_of_sides(std::int32_t f, const Vec3& p, double margin_m) const {
  const Facet& plane = facets_[facets_[f].group];
  const Vec3 foot = p - plane.normal * height(f, p);
  for (const auto& side : facets_[f].sides) {
    const Edge& e = edges_[side.edge];
    if (!side.smooth && distance_to_segment(foot, e.start, e.direction, e.length) <= margin_m) return false;
  }
  return true;
}

bool WallSurface::edge_is_minimum(std::int32_t number, const Vec3& p) const {
  const Edge& edge = edges_[number];
  const double t = edge.along(p);
  if (!(t > 0 && t < edge.length)) return false;
  for (const auto n : edge.facets)
    if (facets_[n].stands && inside_by(side_of(n, number), p) > 0) return false;
  return true;
}

bool WallSurface::vertex_is_minimum(std::int32_t vertex, const Vec3& p) const {
  for (const auto n : edges_of_vertex_[vertex]) {
    const Edge& e = edges_[n];
    const bool stands =
        std::any_of(e.facets.begin(), e.facets.end(), [&](auto f) { return facets_[f].stands; });
    if (!stands) continue;
    const double t = e.along(p);
    if (e.ends[0] == vertex ? t > 0 : t < e.length) return false;
  }
  return true;
}

void WallSurface::touches(std::int32_t f, const Vec3& p, double reach_m, std::vector<Touch>& out) const {
  const Facet& facet = facets_[f];
  const double h = height(f, p);
  if (!facet.stands || std::abs(h) >= reach_m) return;
  const auto face = [&] {
    const Facet& plane = facets_[facet.group];
    const Vec3 normal = h < 0 ? plane.normal * -1.0 : plane.normal;
    out.push_back({facet.group, f, Kind::face, p - plane.normal * h, normal, std::abs(h)});
  };
  if (foot_inside(f, p)) return face();
  const auto corner = [&](std::int64_t feature, Kind kind, const Vec3& point) {
    const Vec3 away = p - point;
    const double distance = norm(away);
    if (distance < reach_m && distance > 0)
      out.push_back({feature, f, kind, point, away * (1 / distance), distance});
  };
  for (std::size_t k = 0; k < facet.sides.size(); ++k) {
    const Side& side = facet.sides[k];
    const Edge& e = edges_[side.edge];
    if (edge_is_minimum(side.edge, p)) {
      if (side.smooth) return face();
      corner(edge_feature(side.edge), Kind::edge, e.start + e.direction * e.along(p));
    }
    const auto v = facet.corners[k];
    if (!vertex_is_minimum(v, p)) continue;
    if (vertex_is_flat_[v]) return face();
    corner(vertex_feature(v), Kind::vertex, vertices_[v]);
  }
}

WallSurface::Touch WallSurface::nearest(std::int32_t f, const Vec3& p) const {
  Touch best{facets_[f].group, f, Kind::edge, {}, {}, infinity};
  for (const auto& side : facets_[f].sides) {
    const Edge& e = edges_[side.edge];
    const Vec3 point = e.start + e.direction * std::clamp(e.along(p), 0.0, e.length);
    const double distance = norm(p - point);
    if (distance < best.distance_m) best.point = point, best.distance_m = distance;
  }
  best.normal = (p - best.point) * (1 / best.distance_m);
  return best;
}

bool WallSurface::vertex_in_group(std::int32_t vertex, std::int32_t group) const {
  for (const auto n : edges_of_vertex_[vertex])
    for (const auto f : edges_[n].facets)
      if (facets_[f].group == group) return true;
  return false;
}

bool WallSurface::adjacent(std::int64_t a, std::int64_t b) const {
  if (a > b) std::swap(a, b);
  const std::int64_t first_edge = facet_count(),
                     first_vertex = first_edge + static_cast<std::int64_t>(edges_.size());
  const auto edge_in_group = [&](const Edge& e, std::int64_t group) {
    return std::any_of(e.facets.begin(), e.facets.end(), [&](auto f) { return facets_[f].group == group; });
  };
  if (b >= first_vertex) {
    const auto v = static_cast<std::int32_t>(b - first_vertex);
    if (a >= first_vertex) return false;
    if (a < first_edge) return vertex_in_group(v, static_cast<std::int32_t>(a));
    const Edge& e = edges_[a - first_edge];
    return e.ends[0] == v || e.ends[1] == v;
  }
  if (b >= first_edge) return a < first_edge && edge_in_group(edges_[b - first_edge], a);
  return std::any_of(edges_.begin(), edges_.end(),
                     [&](const Edge& e) { return edge_in_group(e, a) && edge_in_group(e, b); });
}

}  // namespace granrad
