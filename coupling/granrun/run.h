#pragma once
#include <filesystem>

#include "coupling/granrun/run_options.h"
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// Runs a case into `folder` (see case_folder.h): frames, history, results. Returns the exit code: 0
/// finished, 75 wall time reached, 130/143 interrupted; a checkpoint is saved in each. Throws InputError
/// before anything is written.
int run_case(const Case& c, const std::filesystem::path& folder, const RunOptions& options);

}  // namespace granrad
