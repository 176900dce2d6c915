#pragma once
#include <cstdint>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Planar walls cut into rectangles no longer than a given size, each with a radiosity of its own. Patches
/// are numbered from 0 on, wall by wall, row by row; those outside a wall that is no rectangle see no line.
class WallPatches {
 public:
  /// Throws InputError for a wall that is not in one plane.
  WallPatches(const std::vector<Wall>& walls, double longest_m);

  std::int32_t count() const { return static_cast<std::int32_t>(wall_.size()); }
  /// Index of the wall of a patch.
  std::int32_t wall(std::int32_t patch) const { return wall_[patch]; }
  /// Patch of a point of a wall; points beyond the edge belong to the nearest patch.
  std::int32_t at(std::int32_t wall, const Vec3& point) const;

 private:
  struct Grid {
    Vec3 origin, u, v;  ///< u, v: patches per metre along the sides
    std::int32_t columns, rows, first;
  };
  std::vector<Grid> grid_;
  std::vector<std::int32_t> wall_;
};

}  // namespace granrad
