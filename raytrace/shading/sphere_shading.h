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

/// All pairs of spheres that see anything of each other, as far apart as more than 5e-4 of what a sphere sends gets by Beer's
/// law, at least 6 diameters (in beds of more than 20 000 spheres not farther than 20 000 neighbours); sorted by
/// (i, j). Spheres block by BeamLines, walls of an enclosure that is not convex by a few of its lines. The same for any
/// threads.
std::vector<VisiblePair> visible_pairs(const Enclosure& enclosure, int threads);

}  // namespace granrad
