#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

class EmptyRoom;

/// Two spheres and what of the lines between them is free.
struct VisiblePair {
  std::int32_t i, j;  ///< i < j
  double distance_m;  ///< of the centres
  double open_share;  ///< in (0, 1]
  double variance;    ///< of it: binomial of its lines
};

/// What spheres see of each other, and what of the walls they hide by that.
struct SphereShading {
  std::vector<VisiblePair> pairs;  ///< sorted by (i, j)
  /// [sphere][wall]: of what a sphere sends, the share that ends on others and would else have met the wall; variance.
  std::vector<double> hidden, hidden_variance;
  /// Share of what a sphere sends that may end on spheres farther away than pairs were followed (Beer's law).
  double beyond = 0;
};

/// All pairs of spheres that see anything of each other, as far apart as more than 5e-4 of what a sphere sends gets by Beer's
/// law, at least 6 diameters (in beds of more than 20 000 spheres not farther than 20 000 neighbours). Spheres block by
/// BeamLines, walls of a room that is not convex by a few of its lines, which also tell what wall lies behind the other
/// sphere. The same for any threads.
SphereShading shade_spheres(const Enclosure& enclosure, const EmptyRoom& room, int threads);

}  // namespace granrad
