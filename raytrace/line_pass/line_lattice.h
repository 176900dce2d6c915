#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/line_pass/line_directions.h"
#include "raytrace/line_pass/line_scene.h"

namespace granrad {

/// A run of cells in one row of a tile that enter or leave the enclosure through one surface.
struct LineSpan {
  std::int64_t begin, end;  ///< cells
  std::int32_t surface;
};

/// The lattice of lines of one direction, and where each line enters and leaves the walls.
/// Column c and row r hold the line through (origin + c, origin + r), in spacings along u and v. The lattice
/// is worked on in square tiles that stay in the cache; each has a margin of cells outside it, so that discs
/// may reach over its border. Cell numbers count within a tile, margin and all.
struct LineLattice {
  double origin_u = 0, origin_v = 0;  ///< spacings
  double depth = 0, depth_end = 0;    ///< spacings; of the nearest and farthest spheres along w
  std::int32_t columns = 0, rows = 0;
  double key_scale = 0;                               ///< depth keys per spacing
  std::int32_t tile_shift = 0;                        ///< tiles have 2^tile_shift columns and rows
  std::int32_t margin = 0, pitch = 0, tile_rows = 0;  ///< of a tile; pitch: cells from row to row
  std::int32_t tiles_across = 0, tiles_down = 0;
  std::vector<std::vector<LineSpan>> entry, exit;  ///< by tile, row-major

  void place(const LineScene& scene, const LineFrame& frame);
  std::int32_t tiles() const { return tiles_across * tiles_down; }
  std::size_t tile_cells() const { return static_cast<std::size_t>(pitch) * tile_rows; }
  std::int32_t first_column(std::int32_t tile) const { return (tile % tiles_across) << tile_shift; }
  std::int32_t first_row(std::int32_t tile) const { return (tile / tiles_across) << tile_shift; }
  /// Cell of a line in a tile, or in its margin.
  std::int32_t cell(std::int32_t tile, std::int32_t column, std::int32_t row) const {
    return (row - first_row(tile) + margin) * pitch + (column - first_column(tile) + margin);
  }
  /// Maps whose cells are row << 16 | column, of the whole lattice.
  LineProjection projection(const LineScene& scene, const LineFrame& frame) const;
};

}  // namespace granrad
