#include "raytrace/line_lattice.h"

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {

struct Point {
  double u, v;
};

/// Column at which an edge crosses a row. The ends are ordered first, so that two faces that share the edge
/// get the same number and leave neither gap nor overlap.
double crossing(Point a, Point b, double row) {
  if (b.v < a.v || (b.v == a.v && b.u < a.u)) std::swap(a, b);
  return a.u + (b.u - a.u) * ((row - a.v) / (b.v - a.v));
}

/// Appends the cells of a convex polygon: row by row, columns in [left, right); those on the lattice.
void fill(const std::vector<Point>& corners, const LineLattice& lattice, std::int32_t surface,
          std::vector<LineSpan>& spans) {
  double low = corners[0].v, high = low;
  for (const Point& p : corners) low = std::min(low, p.v), high = std::max(high, p.v);
  const double last_row = std::min<double>(high, lattice.rows);
  for (auto row = static_cast<std::int64_t>(std::ceil(std::max(low, 0.0))); row < last_row; ++row) {
    double left = 1e300, right = -1e300;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
      if ((a.v <= row) == (b.v <= row)) continue;
      const double u = crossing(a, b, static_cast<double>(row));
      left = std::min(left, u), right = std::max(right, u);
    }
    if (!(left < right)) continue;
    const auto begin = static_cast<std::int64_t>(std::ceil(std::max(left, 0.0))),
               end = static_cast<std::int64_t>(std::ceil(std::min<double>(right, lattice.columns)));
    if (begin < end) spans.push_back({row * lattice.pitch + begin, row * lattice.pitch + end, surface});
  }
}

}  // namespace

void LineLattice::place(const LineScene& scene, const LineFrame& frame) {
  const double per_m = 1 / scene.spacing;
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
  for (const Vec3& p : scene.hull) {
    const double at[3] = {dot(p, frame.u) * per_m, dot(p, frame.v) * per_m, dot(p, frame.w) * per_m};
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
  }
  const double margin = 1 + scene.room_for_images();
  origin_u = low[0] - margin - frame.shift_u;
  origin_v = low[1] - margin - frame.shift_v;
  depth = low[2] - 1 - scene.upstream_m * per_m;
  depth_end = high[2] + 1;
  columns = static_cast<std::int32_t>(high[0] + margin - origin_u) + 1;
  rows = static_cast<std::int32_t>(high[1] + margin - origin_v) + 1;
  pitch = (columns + 2 * line_tile) & ~(line_tile - 1);
  key_scale = (1 << line_key_bits) * 0.999999 / (depth_end - depth);

  entry.clear(), exit.clear();
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
          pitch};
}

}  // namespace granrad
