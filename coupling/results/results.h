#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupling/results/stationary.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/history.h"
#include "coupling/simulation/simulation.h"
#include "coupling/simulation/wall_history.h"

namespace granrad {

/// One wall over the averaging window: heat it gave, by path and in all, and per area of it inside the region.
struct WallResult {
  std::string wall;
  double area_m2 = 0, temperature_K = 0;
  Average Q_ss_W, Q_sfs_W, Q_rad_W, Q_W, flux_W_m2;
};

/// What a case came to: means over the rows of its averaging window.
struct Results {
  double from_s = 0, to_s = 0;
  bool steady = false;
  std::string note;                       ///< when it is not steady: what drifts, and how long it would take
  std::map<std::string, Average> column;  ///< by history column; rows where it is undefined are left out
  std::vector<WallResult> walls;
  double largest_energy_defect = 0;  ///< over the whole run
  double final_mean_temperature_K = 0;

  double mean(const std::string& name) const;
};

/// Means over the stationary window of the history (stationary.h: of the mean temperature, and of h_wp or, without
/// it, of the heat from the walls), or from `average_from_s` on ([output] average_from_s).
Results summarise(const History& history, const std::vector<WallRow>& walls = {},
                  std::optional<double> average_from_s = {});

/// Those of a case on disk, by the window its scene asks for.
Results summarise(const CaseFolder& folder, const Case& c);

/// results.json: every mean with its standard error, the window, and whether it is steady.
void write_results(const CaseFolder& folder, const Case& c, const Results& results);

/// The table at the end of a run.
void print_results(const Case& c, const Results& results, const Simulation& simulation,
                   const CaseFolder& folder);

}  // namespace granrad
