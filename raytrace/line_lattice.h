#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/line_directions.h"
#include "raytrace/line_scene.h"

namespace granrad {

/// A run of cells in one row that enter or leave the enclosure through one surface.
struct LineSpan {
  std::int64_t begin, end;  ///< cells
  std::int32_t surface;
};

/// The lattice of lines of one direction, and where each line enters and leaves the walls.
/// Cell row * pitch + column is the line through (origin + column, origin + row), in spacings along u and v.
struct LineLattice {
  double origin_u = 0, origin_v = 0;  ///< spacings
  double depth = 0, depth_end = 0;    ///< spacings; of the nearest and farthest spheres along w
  std::int32_t columns = 0, rows = 0, pitch = 0;
  double key_scale = 0;  ///< depth keys per spacing
  std::vector<LineSpan> entry, exit;

  void place(const LineScene& scene, const LineFrame& frame);
  std::size_t cell_count() const { return static_cast<std::size_t>(pitch) * (rows + line_tile); }
  LineProjection projection(const LineScene& scene, const LineFrame& frame) const;
};

}  // namespace granrad
