#pragma once
#include <optional>
#include <string>
#include <vector>

#include "coupling/simulation/simulation.h"

namespace granrad {

/// What a run will cost on this machine.
struct Forecast {
  double flow_s = 0, conduction_s = 0, radiation_s = 0,
         output_s = 0;              ///< wall-clock seconds of the whole run
  double radiation_repeated_s = 0;  ///< of radiation_s: geometry, and what is not shared by ranks
  double heat_steps = 0, radiation_updates = 0, mean_count = 0;
  int threads = 1;
  double frame_bytes = 0, frames = 0;
  double memory_bytes = 0;
  double speed_in_contact =
      0;  ///< particle-steps a second the flow is reckoned with; 0: by a trial of the bed
  double total_s() const { return flow_s + conduction_s + radiation_s + output_s; }
};

/// Runs a few heat steps of the bed at time 0, a few seconds, and scales them to the run: flow and conduction with
/// the mean number of particles a feed will bring; beds that are poured, empty or too large to try have the flow of a bed
/// in contact (flow_speed.h); radiation with its rays (many are foreseen from two trials with fewer). Changes `simulation`.
Forecast forecast(const Case& c, Simulation& simulation, int threads);

/// What one source needs for heats of the walls with a standard error of `error` (radiation.error, else 1 %), by one trial
/// on a bed. Its bias (one radiosity for each surface, where that is) comes on top.
struct SourceCost {
  std::string source;
  double seconds = 0, error = 0.01;
};

/// Of every source that serves this bed and tells its error, cheapest first; none without radiating walls or for more
/// than 20 000 particles.
std::vector<SourceCost> source_costs(const Case& c, const Bed& bed, int threads);

}  // namespace granrad
