#pragma once
#include <filesystem>

#include "coupling/granrun/run_options.h"
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// `granrun validate`: heats frozen beds with every source and compares them with the reference; writes
/// validation.csv and report.html into `folder`. Beds: [[validate.snapshot]], else the bed of the scene at
/// time 0. Without [validate] the reference is Embree with 20000 rays per particle when particles and
/// isothermal walls are black (or a wall is excluded), else traced paths; compared are the printed
/// correlation, Embree, lines and paths.
int validate_case(const Case& c, const std::filesystem::path& folder, const RunOptions& options);

}  // namespace granrad
