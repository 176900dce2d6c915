#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

enum class TraceMethod { embree, lines };
const char* to_string(TraceMethod method);

/// What `vfgen trace` is asked for.
struct TraceSettings {
  TraceMethod method = TraceMethod::embree;
  double rays = 10000;                  ///< per particle; walls in proportion to area
  double error = 0;                     ///< > 0: instead of rays, the stated error wanted (stated_error.h)
  std::vector<std::string> hot_walls;   ///< whose particle fluxes the stated error is of; none: wall sums
  Sampling sampling = Sampling::sobol;  ///< embree only
  std::size_t memory_limit_bytes = std::size_t{4} << 30;
  std::optional<double> emissivity;       ///< grey particles: total exchange areas; embree only
  std::optional<double> wall_emissivity;  ///< default: each wall's own
  std::uint64_t seed = 1;
  int threads = 0;
  TraceWatch watch;  ///< progress of the present round, and whether to go on
};

/// Throws InputError, with every problem, for settings that do not go together, walls that are not there, or
/// nothing to trace. `snapshot` names the enclosure in messages.
void require_traceable(const Enclosure& enclosure, const TraceSettings& settings,
                       const std::string& snapshot);

/// Traces, closes (reciprocal) and checks; the caller decides what a failed check means. Throws what
/// require_traceable throws, TraceStopped.
ViewFactorFile trace(const Enclosure& enclosure, const TraceSettings& settings, const std::string& origin);

/// "spent 1.2e+07 rays in 3 rounds, 4.1 s; error 0.96 % of the particle-wall sums (1 % asked for)".
std::string spent_line(const ViewFactorFile& traced);

/// "closure 1.2e-16, reciprocity chi2 1.01, mean chord 1.0002, leaked 0".
std::string self_check_line(const SelfCheck& check);

}  // namespace granrad
