#pragma once
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"
#include "dem/bed/bed.h"

namespace granrad {

/// What a user should know about the results before the run, of the bed it starts with: heat that will not be counted
/// (walls and particles outside the region), coefficients that will not exist (hot walls at several temperatures), a
/// modulus exponent that is not that of a bed at rest. None is an error.
std::vector<std::string> case_notes(const Case& c, const Bed& bed);

}  // namespace granrad
