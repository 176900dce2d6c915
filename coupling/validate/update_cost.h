#pragma once
#include "coupling/simulation/heat_scene.h"
#include "dem/bed/bed.h"

namespace granrad {

/// What one radiation update of a moving bed costs: view factors (or a tracer) made anew.
struct UpdateCost {
  double cpu_s = 0;   ///< of all threads
  double wall_s = 0;  ///< elapsed
};

/// Measured on the bed with the radiation of the case: the median of three updates, one alone where it takes more than a
/// fifth of a second. Zero without radiation or particles.
UpdateCost update_cost(const Case& c, const Bed& bed, int threads);

}  // namespace granrad
