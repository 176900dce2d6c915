#include "raytrace/line_pass/line_lattice.h"

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {

constexpr std::int32_t smallest_tile_shift = 7;  // 74 KB with margins: the second-level cache holds it
constexpr std::int32_t margins_per_tile = 4;

struct Point {
  double u, v;
};

/// Column at which an edge crosses a row. The ends are ordered first, so that two faces that share the edge
/// get the same number and leave neither gap nor overlap.
double crossing(Point a, Point b, double row) {
  if (b.v < a.v || (b.v == a.v && b.u < a.u)) std::swap(a, b);
  return a.u + (b.u - a.u) * ((row - a.v) / (b.v - a.v));
}

/// Appends columns [begin, end) of a row, cut where tiles meet.
void append(const LineLattice& lattice, std::int32_t row, std::int32_t begin, std::int32_t end,
            std::int32_t surface, std::vector<std::vector<LineSpan>>& spans) {
  const std::int32_t first = (row >> lattice.tile_shift) * lattice.tiles_across;
  while (begin < end) {
    const std::int32_t across = begin >> lattice.tile_shift, tile = first + across;
    const std::int32_t cut = std::min(end, (across + 1) << lattice.tile_shift);
    const std::int64_t cell = lattice.cell(tile, begin, row);
    spans[static_cast<std::size_t>(tile)].push_back({cell, cell + cut - begin, surface});
    begin = cut;
  }
}

/// Appends the cells of a convex polygon: row by row, columns in [left, right); those on the lattice.
void fill(const std::vector<Point>& corners, const LineLattice& lattice, std::int32_t surface,
          std::vector<std::vector<LineSpan>>& spans) {
  double low = corners[0].v, high = low;
  for (const Point& p : corners) low = std::min(low, p.v), high = std::max(high, p.v);
  const double last_row = std::min<double>(high, lattice.rows);
  for (auto row = static_cast<std::int32_t>(std::ceil(std::max(low, 0.0))); row < last_row; ++row) {
    double left = 1e300, right = -1e300;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
      if ((a.v <= row) == (b.v <= row)) continue;
      const double u = crossing(a, b, static_cast<double>(row));
      left = std::min(left, u), right = std::max(right, u);
    }
    left = std::max(left, 0.0), right = std::min<double>(right, lattice.columns);
    if (left < right)
      append(lattice, row, static_cast<std::int32_t>(std::ceil(left)),
             static_cast<std::int32_t>(std::ceil(right)), surface, spans);
  }
}

void clear(std::vector<std::vector<LineSpan>>& spans, std::int32_t tiles) {
  spans.resize(static_cast<std::size_t>(tiles));
  for (auto& of_tile : spans) of_tile.clear();
}

}  // namespace

void LineLattice::place(const LineScene& scene, const LineFrame& frame) {
  const double per_m = 1 / scene.spacing;
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
  for (const Vec3& p : scene.hull) {
    const double at[3] = {dot(p, frame.u) * per_m, dot(p, frame.v) * per_m, dot(p, frame.w) * per_m};
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
  }
  const double around = 1 + scene.room_for_images();
  origin_u = low[0] - around - frame.shift_u;
  origin_v = low[1] - around - frame.shift_v;
  depth = low[2] - 1 - scene.upstream_m * per_m;
  depth_end = high[2] + 1;
  columns = static_cast<std::int32_t>(high[0] + around - origin_u) + 1;
  rows = static_cast<std::int32_t>(high[1] + around - origin_v) + 1;
  const float largest = scene.reach.empty() ? 0 : *std::max_element(scene.reach.begin(), scene.reach.end());
  margin = (static_cast<std::int32_t>(2 * largest) + line_tile) & ~(line_tile - 1);
  tile_shift = smallest_tile_shift;
  while (1 << tile_shift < margins_per_tile * margin) ++tile_shift;
  pitch = std::min(1 << tile_shift, columns) + 2 * margin;
  tile_rows = std::min(1 << tile_shift, rows) + 2 * margin;
  tiles_across = (columns >> tile_shift) + 1, tiles_down = (rows >> tile_shift) + 1;
  key_scale = (1 << line_key_bits) * 0.999999 / (depth_end - depth);

  clear(entry, tiles()), clear(exit, tiles());
  std::vector<Point> corners;
  for (const auto& face : scene.faces) {
    corners.clear();
    for (const Vec3& p : face.corners)
      corners.push_back({dot(p, frame.u) * per_m - origin_u, dot(p, frame.v) * per_m - origin_v});
    const bool enters = dot(face.normal, frame.w) > 0;
    if (enters || !face.image) fill(corners, *this, face.surface, enters ? entry : exit);
  }
}

LineProjection LineLattice::projection(const LineScene& scene, const LineFrame& frame) const {
  const double s = 1 / scene.spacing, k = s * key_scale;
  return {{frame.u.x * s, frame.u.y * s, frame.u.z * s, -origin_u},
          {frame.v.x * s, frame.v.y * s, frame.v.z * s, -origin_v},
          {frame.w.x * k, frame.w.y * k, frame.w.z * k, -depth * key_scale},
          1 << 16};
}

}  // namespace granrad
