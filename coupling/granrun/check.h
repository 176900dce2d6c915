#pragma once
#include "coupling/granrun/run_options.h"
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// Prints the scene in force, every step limit with its value, what will be modelled, and what was left out
/// and why. With `defaults` the scene is printed with every default in force, as comments. Throws InputError with every problem found.
int check_case(const Case& c, const RunOptions& options, bool defaults = false);

}  // namespace granrad
