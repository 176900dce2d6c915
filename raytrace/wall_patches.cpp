#include "raytrace/wall_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

using Polygon = std::vector<Vec3>;

/// The convex hull of points of a plane, anticlockwise about its normal, without corners on straight edges (Andrew's
/// monotone chain).
Polygon hull(Polygon points, const Vec3& normal) {
  const Vec3 across = normalized(std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  const Vec3 u = normalized(across - dot(across, normal) * normal), v = cross(normal, u);
  const auto place = [&](const Vec3& p) { return std::array{dot(u, p), dot(v, p)}; };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return place(a) < place(b); });
  constexpr double straight = 1e-9;  // of the squared sides: rounding of corners
  Polygon chain;
  for (int half = 0; half < 2; ++half, std::reverse(points.begin(), points.end())) {
    const std::size_t first = chain.size();
    for (const Vec3& p : points) {
      while (chain.size() >= first + 2) {
        const Vec3 a = chain.back() - chain[chain.size() - 2], b = p - chain.back();
        if (dot(normal, cross(a, b)) > straight * (dot(a, a) + dot(b, b))) break;
        chain.pop_back();
      }
      chain.push_back(p);
    }
    chain.pop_back();
  }
  return chain;
}

/// Sets of triangles in one plane that hang together by edges, as the root of each triangle.
std::vector<std::size_t> planar_sets(const Wall& wall, const std::vector<WallFace>& faces) {
  constexpr double parallel = 1 - 1e-10;
  std::vector<std::size_t> root(faces.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  std::multimap<std::pair<std::int32_t, std::int32_t>, std::size_t>
      at_edge;  // four meet where a sheet has two sides
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const auto edge = std::minmax(wall.triangles[t][c], wall.triangles[t][(c + 1) % 3]);
      for (auto [other, end] = at_edge.equal_range(edge); other != end; ++other)
        if (dot(faces[t].normal, faces[other->second].normal) > parallel) {
          const std::size_t one = find(t), two = find(other->second);
          root[std::max(one, two)] = std::min(one, two);
        }
      at_edge.emplace(edge, t);
    }
  for (std::size_t t = 0; t < root.size(); ++t) root[t] = find(t);
  return root;
}

/// Convex polygons that tile a wall: itself; of a mesh the convex polygons that triangles of one plane tile together, and the
/// triangles beside them.
std::vector<Polygon> tiles_of(const Wall& wall) {
  if (wall.triangles.empty()) return {wall.vertices};
  const std::vector<WallFace> faces = faces_of(wall);
  const auto root = planar_sets(wall, faces);
  std::map<std::size_t, std::vector<std::size_t>> sets;
  for (std::size_t t = 0; t < faces.size(); ++t)
    if (is_finite(faces[t].normal)) sets[root[t]].push_back(t);
  std::vector<Polygon> tiles;
  for (const auto& [first, set] : sets) {
    Polygon corners;
    double set_m2 = 0;
    for (const std::size_t t : set) {
      set_m2 += polygon_area(faces[t].vertices);
      corners.insert(corners.end(), faces[t].vertices.begin(), faces[t].vertices.end());
    }
    Polygon whole = hull(corners, faces[first].normal);
    constexpr double rounding = 1e-6;  // of single precision in STL files
    if (whole.size() >= 3 && std::abs(polygon_area(whole) - set_m2) <= rounding * set_m2)
      tiles.push_back(std::move(whole));
    else
      for (const std::size_t t : set) tiles.push_back(faces[t].vertices);
  }
  return tiles;
}

/// Where an edge crosses a level; both neighbours of an edge get the same point.
Vec3 crossing(Vec3 a, Vec3 b, double height_a, double height_b) {
  if (std::array{b.x, b.y, b.z} < std::array{a.x, a.y, a.z}) std::swap(a, b), std::swap(height_a, height_b);
  return a + height_a / (height_a - height_b) * (b - a);
}

/// The parts of a convex polygon below and above a level.
std::pair<Polygon, Polygon> split(const Polygon& polygon, const Vec3& normal, double offset) {
  std::pair<Polygon, Polygon> parts;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double from = dot(normal, a) - offset, to = dot(normal, b) - offset;
    if (from <= 0) parts.first.push_back(a);
    if (from >= 0) parts.second.push_back(a);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
      const Vec3 between = crossing(a, b, from, to);
      parts.first.push_back(between);
      parts.second.push_back(between);
    }
  }
  return parts;
}

}  // namespace

struct WallPatches::Grid {
  Vec3 direction[2];
  double longest_m;
};

/// Halves the longer side (in patches) until patches are short enough. Returns the cut, or ~patch.
std::int32_t WallPatches::divide(Polygon polygon, const Grid& grid, std::int32_t wall) {
  double low[2], length[2];
  int pieces[2];
  for (int k = 0; k < 2; ++k) {
    const auto along = [&](const Vec3& p) { return dot(grid.direction[k], p); };
    const auto [least, most] = std::minmax_element(
        polygon.begin(), polygon.end(), [&](const Vec3& a, const Vec3& b) { return along(a) < along(b); });
    low[k] = along(*least), length[k] = along(*most) - low[k];
    pieces[k] = std::max(1, static_cast<int>(std::ceil(length[k] / grid.longest_m * (1 - 1e-9))));
  }
  const int k = pieces[0] >= pieces[1] ? 0 : 1;
  if (pieces[k] == 1) {
    wall_.push_back(wall);
    corners_.push_back(std::move(polygon));
    return ~(count() - 1);
  }
  const int below_count = pieces[k] / 2;
  const double offset = low[k] + length[k] * below_count / pieces[k];
  auto [below, above] = split(polygon, grid.direction[k], offset);
  const auto at = cuts_.size();
  cuts_.push_back({grid.direction[k], offset, {}});
  const std::int32_t first = divide(std::move(below), grid, wall);
  const std::int32_t second = divide(std::move(above), grid, wall);
  cuts_[at].child[0] = first, cuts_[at].child[1] = second;
  return static_cast<std::int32_t>(at);
}

WallPatches::WallPatches(const std::vector<Wall>& walls, double longest_m, const std::vector<char>& cut) {
  constexpr std::size_t most_tiles = 1000;  // of a wall: finer meshes stay whole
  for (std::size_t w = 0; w < walls.size(); ++w) {
    first_.push_back(count());
    first_tile_.push_back(tiles_.size());
    std::vector<Polygon> tiles;
    if (cut.empty() || cut[w]) tiles = tiles_of(walls[w]);
    if (tiles.empty() || tiles.size() > most_tiles) {
      wall_.push_back(static_cast<std::int32_t>(w));
      corners_.emplace_back();
      continue;
    }
    for (Polygon& polygon : tiles) {
      Grid grid{{normalized(polygon[1] - polygon[0]), {}}, longest_m};
      grid.direction[1] = cross(polygon_normal(polygon), grid.direction[0]);
      const std::int32_t root = divide(polygon, grid, static_cast<std::int32_t>(w));
      tiles_.push_back({make_face(std::move(polygon)), root});
    }
  }
  first_tile_.push_back(tiles_.size());
}

const WallPatches::Tile& WallPatches::tile_at(std::size_t wall, const Vec3& point,
                                              const Vec3& seen_from) const {
  const auto begin = tiles_.begin() + static_cast<std::ptrdiff_t>(first_tile_[wall]),
             end = tiles_.begin() + static_cast<std::ptrdiff_t>(first_tile_[wall + 1]);
  if (end - begin == 1) return *begin;
  constexpr double rounding = 1e-9;  // of a face: what shows its back is farther by that
  const auto away_m = [&](const Tile& tile) {
    const bool front = dot(tile.face.normal, seen_from - tile.face.vertices[0]) > 0;
    const double extent_m = norm(tile.face.bounds.max - tile.face.bounds.min);
    return distance_to(tile.face, point) + (front ? 0 : rounding * extent_m);
  };
  return *std::min_element(begin, end, [&](const Tile& a, const Tile& b) { return away_m(a) < away_m(b); });
}

std::int32_t WallPatches::at(std::int32_t wall, const Vec3& point, const Vec3& seen_from) const {
  if (!is_cut(wall)) return first(wall);
  std::int32_t node = tile_at(static_cast<std::size_t>(wall), point, seen_from).root;
  while (node >= 0) {
    const Cut& cut = cuts_[static_cast<std::size_t>(node)];
    node = cut.child[dot(cut.normal, point) < cut.offset ? 0 : 1];
  }
  return ~node;
}

double patch_length_m(const Enclosure& enclosure, const std::vector<char>& cut) {
  constexpr double of_free_path = 0.22, least_diameters = 0.5, most_diameters = 2;
  constexpr double least_patches = 400, patches_per_sphere = 2;
  double cut_m2 = 0, squares = 0, cubes = 0;
  for (std::size_t w = 0; w < cut.size(); ++w)
    if (cut[w]) cut_m2 += area(enclosure.walls[w]);
  Box around = Box::empty();
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const double r = enclosure.radius_m[i];
    squares += r * r, cubes += r * r * r;
    around.include(enclosure.centre_m[i], r);
  }
  const double most = least_patches + patches_per_sphere * static_cast<double>(enclosure.sphere_count());
  const double affordable_m = std::sqrt(cut_m2 / most);
  if (squares == 0) return affordable_m;
  const double diameter_m = 2 * cubes / squares;
  const double free_m3 = std::max(0.0, around.volume() - 4 * pi / 3 * cubes);
  const double free_path_m = free_m3 / (pi * squares);  // 4 V / S
  return std::max(affordable_m, std::clamp(of_free_path * free_path_m, least_diameters * diameter_m,
                                           most_diameters * diameter_m));
}

Enclosure WallPatches::applied_to(const Enclosure& whole) const {
  Enclosure cut = whole;
  cut.walls.clear();
  cut.wall.clear();
  for (std::int32_t patch = 0; patch < count(); ++patch) {
    const auto w = static_cast<std::size_t>(wall(patch));
    cut.walls.push_back(whole.walls[w]);
    if (!whole.wall.empty()) cut.wall.push_back(whole.wall[w]);
    if (!is_cut(wall(patch))) continue;
    cut.walls.back().vertices = corners(patch);
    cut.walls.back().triangles.clear();
  }
  return cut;
}

}  // namespace granrad
