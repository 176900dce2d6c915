#pragma once
#include <chrono>
#include <string>

#include "coupling/granrun/run_options.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/simulation.h"

namespace granrad {

/// A line on stderr, unless quiet.
void say(const RunOptions& options, const std::string& text);

/// The time loop, from where the simulation stands to its end or until it must stop: rows, frames, checkpoints.
/// Returns 0, or the exit code to stop with (wall time, a signal). Whatever ends it early, a refusal in the middle of
/// a step too, leaves a checkpoint that leads on. Throws what the simulation throws, with the way on.
int follow(Simulation& simulation, const Case& c, const CaseFolder& folder, const RunOptions& options,
           std::chrono::steady_clock::time_point start);

}  // namespace granrad
