#pragma once
#include <string>
#include <vector>

#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/history.h"
#include "coupling/simulation/simulation.h"

namespace granrad {

/// A column of the history, averaged.
struct Average {
  double mean = 0;
  double standard_error =
      0;  ///< of the mean, from the scatter of 8 batches of rows; nan with fewer than 16 rows
};

/// What a case came to: means over the second half of its time, when a flow has become steady.
struct Results {
  double from_s = 0, to_s = 0;
  std::map<std::string, Average> column;  ///< by history column; rows where it is undefined are left out
  double largest_energy_defect = 0;       ///< over the whole run
  double final_mean_temperature_K = 0;

  double mean(const std::string& name) const;
};

Results summarise(const History& history);

/// The table at the end of a run.
void print_results(const Case& c, const Results& results, const Simulation& simulation,
                   const CaseFolder& folder);

}  // namespace granrad
