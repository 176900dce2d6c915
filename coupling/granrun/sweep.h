#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// One case of a sweep.
struct SweepCase {
  std::string name;                    ///< folder below the sweep's
  std::vector<std::string> overrides;  ///< "key=value"
};

/// A parameter study. File:
///   [sweep]  scene = "plug.toml"
///   [[vary]] key = "feed.solid_fraction"  values = [0.07, 0.25]          # every combination of all [[vary]]
///   [[vary]] key = "radiation.source"     texts = ["paths", "lines"]
///   [[case]] name = "hot"                 set = ["walls.y_min.temperature_K=1300"]   # a single case beside
///   them
struct Sweep {
  std::filesystem::path scene;
  std::vector<SweepCase> cases;
};

/// Throws InputError (every problem), IoError.
Sweep read_sweep(const std::filesystem::path& file);

/// Runs every case that is not finished, into folder/NAME, and keeps folder/sweep.csv (means of each) and
/// folder/jobs.txt (one granrun command a line, for a cluster's array job) up to date. `list_only`: jobs.txt
/// alone. All cases are read before the first runs. Returns 0, the code of an interruption, or 1 when cases
/// failed.
int run_sweep(const std::filesystem::path& file, const std::filesystem::path& folder, bool list_only,
              const RunOptions& options);

}  // namespace granrad
