#include "raytrace/wall_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

using Polygon = std::vector<Vec3>;

/// The polygon of a wall that is one, or nothing.
Polygon polygon_of(const Wall& wall) {
  return wall.triangles.empty() && plane_of(wall) ? wall.vertices : Polygon{};
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
  const double offset = low[k] + length[k] * (pieces[k] / 2) / pieces[k];
  auto [below, above] = split(polygon, grid.direction[k], offset);
  const auto at = cuts_.size();
  cuts_.push_back({grid.direction[k], offset, {}});
  const std::int32_t first = divide(std::move(below), grid, wall);
  const std::int32_t second = divide(std::move(above), grid, wall);
  cuts_[at].child[0] = first, cuts_[at].child[1] = second;
  return static_cast<std::int32_t>(at);
}

WallPatches::WallPatches(const std::vector<Wall>& walls, double longest_m, const std::vector<char>& cut) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    first_.push_back(count());
    Polygon polygon;
    if (cut.empty() || cut[w]) polygon = polygon_of(walls[w]);
    if (polygon.empty()) {
      tree_.push_back(-1);
      wall_.push_back(static_cast<std::int32_t>(w));
      corners_.emplace_back();
      continue;
    }
    Grid grid{{normalized(polygon[1] - polygon[0]), {}}, longest_m};
    grid.direction[1] = cross(polygon_normal(polygon), grid.direction[0]);
    tree_.push_back(divide(std::move(polygon), grid, static_cast<std::int32_t>(w)));
    if (tree_.back() < 0) tree_.back() = -1;
  }
}

std::int32_t WallPatches::at(std::int32_t wall, const Vec3& point) const {
  std::int32_t node = tree_[static_cast<std::size_t>(wall)];
  if (node < 0) return first(wall);
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
