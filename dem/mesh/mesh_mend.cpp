#include "dem/mesh/mesh_mend.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "dem/base/error.h"
#include "dem/mesh/winding.h"

namespace granrad {

namespace {

/// Points by place: those within the tolerance of an earlier one are that one.
class Welder {
 public:
  /// `origin`: near all points, so that cells are numbered from there.
  Welder(double tolerance, const Vec3& origin)
      : tolerance_(tolerance), cell_m_(tolerance > 0 ? tolerance : 1), origin_(origin) {}

  std::int32_t index_of(const Vec3& p, std::size_t& welded) {
    const auto home = cell_of(p);
    std::int32_t best = -1;
    double nearest = tolerance_;
    visit_around(home, [&](std::int32_t k) {
      if (const double apart = norm(points[static_cast<std::size_t>(k)] - p); apart <= nearest) {
        nearest = apart;
        best = k;
      }
    });
    if (best >= 0) {
      welded += nearest > 0;
      return best;
    }
    points.push_back(p);
    cells_[key(home)].push_back(static_cast<std::int32_t>(points.size() - 1));
    return static_cast<std::int32_t>(points.size() - 1);
  }

  std::vector<Vec3> points;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor((p[axis] - origin_[axis]) / cell_m_));
    return cell;
  }
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c[0]) * 73856093u ^ static_cast<std::uint64_t>(c[1]) * 19349663u ^
           static_cast<std::uint64_t>(c[2]) * 83492791u;
  }
  template <class Visit>
  void visit_around(const Cell& home, Visit&& visit) const {
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key({home[0] + x, home[1] + y, home[2] + z}));
          if (found == cells_.end()) continue;
          for (const auto k : found->second) visit(k);
        }
  }

  double tolerance_, cell_m_;
  Vec3 origin_;
  std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;
};

/// The same triangle, whichever corner stands first.
Triangle turned_to_least(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Distance of p from the segment a-b, infinite where its foot is not between them.
double off_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a, to = p - a;
  const double part = dot(to, along) / dot(along, along);
  return part > 0 && part < 1 ? norm(to - part * along) : infinity;
}

class Mender {
 public:
  Mender(double tolerance, const Vec3& origin, MeshMending& mending)
      : tolerance_(tolerance), mending_(mending), welder_(tolerance, origin) {}

  std::vector<Triangle> take(const Facets& mesh) {
    std::vector<Triangle> triangles;
    std::set<Triangle> known;
    for (std::size_t k = 0; k + 2 < mesh.corners.size(); k += 3) {
      Triangle t{};
      for (std::size_t c = 0; c < 3; ++c) t[c] = welder_.index_of(mesh.corners[k + c], mending_.welded);
      if (is_flat(t))
        ++mending_.flat;
      else if (!known.insert(turned_to_least(t)).second)
        ++mending_.doubled;
      else
        triangles.push_back(t);
    }
    return triangles;
  }

  /// Cuts triangles of all meshes at the vertices that lie on their open edges.
  void cut_at_vertices(std::vector<std::vector<Triangle>>& meshes) {
    const auto loose = open_edges(meshes);
    if (loose.empty()) return;
    std::vector<std::int32_t> ends;  // only the ends of open edges can lie on another open edge
    for (const auto& [edge, uses] : loose) ends.insert(ends.end(), {edge.first, edge.second});
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::sort(ends.begin(), ends.end(),
              [&](std::int32_t a, std::int32_t b) { return point(a).x < point(b).x; });
    for (auto& triangles : meshes) cut(triangles, loose, ends);
  }

  std::vector<Wall> walls(const std::vector<Facets>& meshes, const std::vector<std::vector<Triangle>>& kept,
                          double scale) const {
    std::vector<Wall> walls;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      if (kept[m].empty()) continue;
      Wall wall;
      wall.name = meshes[m].name;
      std::map<std::int32_t, std::int32_t> own;
      for (const Triangle& t : kept[m]) {
        Triangle renumbered{};
        for (std::size_t c = 0; c < 3; ++c) {
          const auto [at, is_new] = own.emplace(t[c], static_cast<std::int32_t>(own.size()));
          if (is_new) wall.vertices.push_back(scale * point(t[c]));
          renumbered[c] = at->second;
        }
        wall.triangles.push_back(renumbered);
      }
      walls.push_back(std::move(wall));
    }
    return walls;
  }

 private:
  using Edge = std::pair<std::int32_t, std::int32_t>;
  const Vec3& point(std::int32_t k) const { return welder_.points[static_cast<std::size_t>(k)]; }

  double twice_area(const Triangle& t) const {
    return norm(cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])));
  }

  /// Lower than the tolerance over its longest side.
  bool is_flat(const Triangle& t) const {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
    const Vec3 &a = point(t[0]), &b = point(t[1]), &c = point(t[2]);
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return twice_area(t) <= tolerance_ * longest;
  }

  static std::map<Edge, int> open_edges(const std::vector<std::vector<Triangle>>& meshes) {
    std::map<Edge, int> uses;
    for (const auto& triangles : meshes)
      for (const Triangle& t : triangles)
        for (std::size_t c = 0; c < 3; ++c) ++uses[std::minmax(t[c], t[(c + 1) % 3])];
    std::erase_if(uses, [](const auto& edge) { return edge.second != 1; });
    return uses;
  }

  /// Of `ends`, sorted by x, the one on the edge that is nearest to a; -1 when there is none.
  std::int32_t vertex_on(std::int32_t a, std::int32_t b, const std::vector<std::int32_t>& ends) const {
    const Vec3 &p = point(a), &q = point(b);
    const double low = std::min(p.x, q.x) - tolerance_, high = std::max(p.x, q.x) + tolerance_;
    std::int32_t best = -1;
    for (auto at = std::lower_bound(ends.begin(), ends.end(), low,
                                    [&](std::int32_t k, double x) { return point(k).x < x; });
         at != ends.end() && point(*at).x <= high; ++at) {
      if (*at == a || *at == b || off_edge(point(*at), p, q) > tolerance_) continue;
      if (best < 0 || norm(point(*at) - p) < norm(point(best) - p)) best = *at;
    }
    return best;
  }

  void cut(std::vector<Triangle>& triangles, const std::map<Edge, int>& loose,
           const std::vector<std::int32_t>& ends) {
    for (std::size_t k = 0; k < triangles.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const Triangle t = triangles[k];
        const std::int32_t a = t[c], b = t[(c + 1) % 3], apex = t[(c + 2) % 3];
        if (!loose.count(std::minmax(a, b)) && !cut_here_.count(std::minmax(a, b))) continue;
        const std::int32_t middle = vertex_on(a, b, ends);
        const Triangle first{a, middle, apex}, rest{middle, b, apex};
        if (middle < 0 || middle == apex || is_flat(first) || is_flat(rest)) continue;
        if (std::max(twice_area(first), twice_area(rest)) >= twice_area(t)) continue;  // so that cutting ends
        triangles[k] = first;
        triangles.push_back(rest);
        cut_here_.insert(std::minmax(a, middle)), cut_here_.insert(std::minmax(middle, b));
        ++mending_.split;
        --k;  // the shorter one again
        break;
      }
  }

  double tolerance_;
  MeshMending& mending_;
  Welder welder_;
  std::set<Edge> cut_here_;  ///< parts of open edges that were cut
};

}  // namespace

std::string MeshMending::note() const {
  std::vector<std::string> parts;
  if (welded > 0)
    parts.push_back(fmt::format("{} corners within {:.2g} m of another joined to it", welded, tolerance_m));
  if (flat > 0) parts.push_back(fmt::format("{} triangles without area left out", flat));
  if (doubled > 0) parts.push_back(fmt::format("{} triangles given twice left out", doubled));
  if (turned > 0) parts.push_back(fmt::format("{} triangles turned to face as their neighbours", turned));
  if (split > 0) parts.push_back(fmt::format("{} triangles cut at corners on their edges", split));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Wall> mended(const std::vector<Facets>& meshes, double scale, const std::string& file,
                         MeshMending& mending) {
  Box around = Box::empty();
  for (const Facets& mesh : meshes)
    for (const Vec3& corner : mesh.corners) {
      if (!is_finite(corner)) throw InputError(fmt::format("{}: a vertex is not finite", file));
      around.include(corner);
    }
  if (around.is_empty()) return {};
  const double tolerance = weld_tolerance * norm(around.size());
  if (!std::isfinite(tolerance) || !std::isfinite(tolerance * scale))
    throw InputError(fmt::format("{}: its vertices are too far apart to be computed with", file));
  mending.tolerance_m = scale * tolerance;
  Mender mender(tolerance, around.min, mending);
  std::vector<std::vector<Triangle>> kept;
  for (const Facets& mesh : meshes) kept.push_back(mender.take(mesh));
  mender.cut_at_vertices(kept);
  mending.turned = wind_alike(kept);
  return mender.walls(meshes, kept, scale);
}

}  // namespace granrad
