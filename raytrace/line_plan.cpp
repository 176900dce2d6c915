#include "raytrace/line_plan.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/scene/error.h"

namespace granrad {

void check_line_options(const LineOptions& options) {
  std::vector<std::string> problems;
  if (options.directions < 1)
    problems.push_back(fmt::format("lines: directions = {} (must be at least 1)", options.directions));
  if (options.replicates < 2)
    problems.push_back(
        fmt::format("lines: replicates = {} (errors come from at least 2)", options.replicates));
  if (!(options.lines_per_disc > 0) || !std::isfinite(options.lines_per_disc))
    problems.push_back(fmt::format("lines: lines_per_disc = {} (must be positive)", options.lines_per_disc));
  if (!(options.target_error >= 0))
    problems.push_back(fmt::format("lines: target_error = {} (must not be negative)", options.target_error));
  if (!problems.empty()) throw InputError(problems);
}

int line_threads(int asked) {
  return asked > 0 ? asked : omp_get_max_threads();
}

int more_directions(int directions, double error, double target) {
  const double factor = std::clamp(1.1 * (error / target) * (error / target), 1.3, 4.0);
  const double wanted = std::ceil(directions * factor);
  if (wanted > 16777216)
    throw ThresholdMissed(fmt::format("lines: error {:.3g} after {} directions, {} asked for: out of reach",
                                      error, directions, target));
  return static_cast<int>(wanted);
}

}  // namespace granrad
