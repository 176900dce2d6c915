#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/granrun/run_options.h"
#include "coupling/measure/conductivity.h"

namespace granrad {

/// `granrun measure conductivity`.
struct ConductivityCommand {
  std::filesystem::path bed;                    ///< a scene, or a frame, CSV or dump for the bed of `scene`
  std::filesystem::path scene;                  ///< whose walls and materials a bed gets that is no scene
  std::vector<std::string> overrides, removed;  ///< of the scene
  std::string between = "z";
  double temperature_K = 0;  ///< 0: the mean of the plates, else of the particles
  double rays = 2000;
  int replicates = 4;
};

/// Measures (conductivity.h) and writes measure.json and report.html into `folder`. Radiation counts when the
/// scene has a source. Throws InputError before anything is written.
int measure_case(const ConductivityCommand& command, const std::filesystem::path& folder,
                 const RunOptions& options);

}  // namespace granrad
