#pragma once
#include "coupling/heat_scene.h"
#include "coupling/run_options.h"

namespace granrad {

/// Prints the scene in force, every step limit with its value, what will be modelled, and what was left out
/// and why. Throws InputError with every problem found.
int check_case(const Case& c, const RunOptions& options);

}  // namespace granrad
