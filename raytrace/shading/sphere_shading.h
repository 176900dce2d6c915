#pragma once
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// Two spheres and what of the lines between them is free.
struct VisiblePair {
  std::int32_t i, j;  ///< i < j
  double distance_m;  ///< of the centres
  double open_share;  ///< in (0, 1]
};

/// All pairs of spheres up to BeamLines::longest diameters apart that see anything of each other; sorted by (i, j). Spheres
/// block by BeamLines, walls of an enclosure that is not convex by a few of its lines. The same for any threads.
std::vector<VisiblePair> visible_pairs(const Enclosure& enclosure, int threads);

}  // namespace granrad
