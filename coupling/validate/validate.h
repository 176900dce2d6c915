#pragma once
#include <filesystem>
#include <vector>

#include "coupling/granrun/run_options.h"
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// What `granrun validate` is asked for beside the scenes.
struct ValidateOptions {
  double max_error_pct = 0;  ///< > 0: a larger error of mean temperature or flux is a missed threshold
};

/// `granrun validate`: heats frozen beds with every source and compares them with the reference; writes
/// validation.csv and report.html into `folder`. Beds: [[validate.snapshot]], else the bed of the scene at
/// time 0. Without [validate] the reference is Embree with 20000 rays per particle when particles and
/// isothermal walls are black (or a wall is excluded), else traced paths; compared are the printed
/// correlation, and Embree, lines and paths on ladders of rays. Several cases (scenes, emissivities) go into the same
/// tables. particles.csv holds temperature and flux of every particle under the last step of each ladder. Throws
/// ThresholdMissed, after everything is written, when a source exceeds max_error_pct at the last step of its ladder.
int validate_cases(const std::vector<Case>& cases, const std::filesystem::path& folder,
                   const ValidateOptions& asked, const RunOptions& options);

}  // namespace granrad
