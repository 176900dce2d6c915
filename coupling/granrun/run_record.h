#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coupling/granrun/run_options.h"
#include "coupling/results/results.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/simulation.h"

namespace granrad {

/// What report and export need of run.json.
struct RunRecord {
  std::string scene_name = "case", program_version, git_sha, radiation;
  bool finished = false;
  double end_time_s = 0;  ///< where the run ends
  std::vector<std::pair<std::string, std::string>>
      provenance;  ///< what, text: command, host, dates, versions, seeds
};

/// run.json: where a result came from. Versions of the program and its libraries, git commit, host, threads,
/// command line, dates, wall time, seeds, hash of the scene, steps; with `results` also `finished` and the
/// means of summarise(). A continued run keeps the date of its first start and adds up its wall time.
void write_run_record(const CaseFolder& folder, const Case& c, const Simulation& simulation,
                      const RunOptions& options, const Results* results = nullptr);

/// Throws IoError when run.json is damaged.
RunRecord read_run_record(const CaseFolder& folder);

/// True when run.json says that the case ran to the end of this scene's time.
bool is_finished(const std::filesystem::path& folder);

}  // namespace granrad
