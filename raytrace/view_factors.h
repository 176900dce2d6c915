#pragma once
#include <cstdint>
#include <string>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/sampling.h"

namespace granrad {

/// How many rays, and how they are drawn.
struct TraceOptions {
  double rays_per_particle =
      10000;  ///< walls get rays in proportion to area, at the mean density of the particles
  /// > 0: rays are chosen so that the standard error of the particles' sums over all walls and surroundings,
  /// rms over the particles and relative to their mean, is below it; spent where the error is (n_i ~ sqrt(p_i
  /// (1 - p_i))).
  double target_error = 0;
  Sampling sampling = Sampling::sobol;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default; results do not depend on it
  std::size_t memory_limit_bytes = std::size_t{4}
                                   << 30;  ///< of tracing and closing; see HitCounts::thinning_unit
};

/// Checks every run makes on itself; printed in one line and stored. `failed` says which, empty when sound.
struct SelfCheck {
  double closure_defect = 0;    ///< fraction of rays lost in rows before closure
  double reciprocity_chi2 = 0;  ///< reduced chi^2 of A_i F_ij - A_j F_ji
  double mean_chord_ratio = 0;  ///< measured / (4 V_void / S_total); 0 when the volume is not known
  std::int64_t leaked = 0;
  std::string failed;
};

/// View factors of an enclosure by Embree: hit counts of every surface.
HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options);

/// Total exchange-factor counts for grey surfaces: rays followed until absorbed (Russian roulette on the
/// emissivity of each surface hit); hits[k] counts absorptions. emissivity by surface number.
HitCounts trace_total_exchange(const Enclosure& enclosure, const std::vector<double>& emissivity,
                               const TraceOptions& options);

/// Standard error of the particles' sums over walls and surroundings, rms relative to their mean: the
/// quantity that target_error bounds. 0 without particles.
double wall_sum_error(const Enclosure& enclosure, const HitCounts& counts);

/// Leaked rays, rows that do not add up, counts that disagree between the two ends of a pair, and a mean free
/// path off 4 V / S by more than its error. V is known when the walls close or all directions are periodic.
SelfCheck self_check(const Enclosure& enclosure, const HitCounts& counts);

}  // namespace granrad
