#pragma once
#include "coupling/granrun/run_options.h"
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// What `check` is asked for beside the scene.
struct CheckOptions {
  bool defaults = false;     ///< print every default in force, as comments
  int ranks = 1;             ///< forecast for so many
  std::string slurm{};       ///< file for a job of Slurm
  std::string scene_line{};  ///< the scene and what edits it, as a shell reads them, for that job
};

/// Prints the scene in force, every step limit with its value, what will be modelled, and what was left out and why; and
/// a forecast. Throws InputError with every problem found, IoError.
int check_case(const Case& c, const RunOptions& options, const CheckOptions& asked);

}  // namespace granrad
