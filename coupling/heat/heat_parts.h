#pragma once
#include <vector>

#include "coupling/heat/heat_step.h"

namespace granrad {

/// advance_temperatures over dt_s in as many equal steps as conduction_step_limit_s asks for, so that conduction follows
/// a bed whose contacts form and grow; by the midpoint rule unless the steps are much shorter than that. `from_walls_J` gets what the particles received from each wall of the Bed through
/// contacts and gas. Throws NumericalError when that takes more than 10^5 steps.
HeatPaths advance_in_parts(Bed& bed, const Conductances& conductances, double dt_s,
                           std::vector<HeatPaths>& from_walls_J);

}  // namespace granrad
