#pragma once
#include <cstdint>
#include <vector>

namespace granrad {

/// Two particles that touched during an advance. i < j.
struct PairTouch {
  std::int32_t i, j;
  double
      root_area_m;  ///< mean over the advance of sqrt(A), A the disc in which they intersect; 0 while apart
};

/// A particle and a wall, over all places where they touched.
struct WallTouch {
  std::int32_t i;
  std::int32_t wall;  ///< index into Bed::walls
  double root_area_m;
};

/// How bodies touched while an engine advanced, however short: a collision lasts some ten steps, an advance hundreds.
struct Touches {
  std::vector<PairTouch> particles;  ///< sorted by (i, j)
  std::vector<WallTouch> walls;      ///< sorted by (i, wall)
};

}  // namespace granrad
