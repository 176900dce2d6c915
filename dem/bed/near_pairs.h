#pragma once
#include <cstdint>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// Two particles whose surfaces are closer than the gap asked for. i < j.
struct NearPair {
  std::int32_t i, j;
  double distance_m;  ///< between the centres (nearest periodic image)
};

/// A particle and a wall. The distance is from the centre to the nearest point of the wall.
struct NearWall {
  std::int32_t i;
  std::int32_t wall;  ///< index into Bed::walls
  double distance_m;
};

struct NearPairs {
  std::vector<NearPair> particles;  ///< sorted by (i, j)
  std::vector<NearWall> walls;      ///< sorted by (i, wall); each wall once per particle
};

/// All pairs with surface gap (distance - r_i - r_j, or distance - r_i) <= max_gap_m, by a cell list.
/// Walls without contact and shutters that are open at bed.time_s are left out. Cost O(N) for similar radii.
NearPairs near_pairs(const Bed& bed, double max_gap_m);

/// Its walls alone.
std::vector<NearWall> near_walls(const Bed& bed, double max_gap_m);

/// Pairs found in any order by several searchers, sorted by (i, j); `particles` is how many there are.
std::vector<NearPair> sorted_by_rows(const std::vector<std::vector<NearPair>>& parts, std::size_t particles);

/// Sorts by (i, wall) and keeps the nearest place of each wall.
void keep_nearest(std::vector<NearWall>& walls);

}  // namespace granrad
