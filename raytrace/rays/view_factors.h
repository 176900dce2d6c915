#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/rays/ray_monitor.h"
#include "raytrace/rays/sampling.h"

namespace granrad {

class WallPatches;

/// How many rays, and how they are drawn.
struct TraceOptions {
  double rays_per_particle =
      10000;  ///< walls get rays in proportion to area, at the mean density of the particles
  /// > 0: rays are chosen so that the stated error (stated_error.h) falls below it, and spent where the error
  /// is (ray_allocation.h). Has no effect without particles.
  double target_error = 0;
  std::vector<std::int32_t>
      hot_walls{};  ///< surface numbers; empty: the error of particle-wall sums is stated
  Sampling sampling = Sampling::sobol;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default; results do not depend on it
  std::size_t memory_limit_bytes = std::size_t{4}
                                   << 30;  ///< of tracing and closing; see HitCounts::thinning_unit
  /// > 1: that many replicates, their hits kept apart in HitCounts::parts (as long as there are fewer than 5e7 rays).
  int kept_replicates = 0;
  TraceWatch watch{};  ///< progress of the present round, and whether to go on
};

/// What a trace spent, and how well it knows what it states.
struct TraceReport {
  std::int64_t rays = 0;  ///< of all rounds; for lines: line ends on surfaces, each worth one ray
  int rounds = 0;         ///< the last one is what is kept
  double seconds = 0;     ///< wall time
  double error = 0;       ///< the stated error reached; 0 without particles
};

/// Checks every run makes on itself; printed in one line and stored. `failed` says which, empty when sound.
struct SelfCheck {
  double closure_defect = 0;    ///< fraction of rays lost in rows before closure
  double reciprocity_chi2 = 0;  ///< reduced chi^2 of A_i F_ij - A_j F_ji
  double mean_chord_ratio = 0;  ///< measured / (4 V_void / S_total); 0 when the volume is not known
  std::int64_t leaked = 0;
  std::string failed;
};

/// View factors of an enclosure by Embree: hit counts of every surface. Throws ThresholdMissed when
/// target_error is out of reach, TraceStopped. `patches`: of the walls; surfaces are then those of
/// patches->applied_to(enclosure).
HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options,
                             TraceReport* report = nullptr, const WallPatches* patches = nullptr);

/// Total exchange-factor counts for grey surfaces: rays followed until absorbed (Russian roulette on the
/// emissivity of each surface hit); hits[k] counts absorptions. emissivity by surface number. The same
/// errors.
HitCounts trace_total_exchange(const Enclosure& enclosure, const std::vector<double>& emissivity,
                               const TraceOptions& options, TraceReport* report = nullptr);

/// Leaked rays, rows that do not add up, counts that disagree between the two ends of a pair, and a mean free
/// path off 4 V / S by more than its error. V is known when the walls close or all directions are periodic. Leaks fail when
/// they are more than `tolerated_leaks` of all rays.
SelfCheck self_check(const Enclosure& enclosure, const HitCounts& counts, double tolerated_leaks = 0);

}  // namespace granrad
