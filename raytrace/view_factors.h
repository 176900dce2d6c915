#pragma once
#include <cstdint>
#include <string>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

enum class Sampling { sobol, plain };

/// How many rays, and how they are drawn.
struct TraceOptions {
  double rays_per_particle = 10000;  ///< walls get rays in proportion to area, at the mean density of the particles
  double target_error = 0;           ///< > 0: stop when the rms relative error of particle-wall sums is below it
  Sampling sampling = Sampling::sobol;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default; results do not depend on it
};

/// Checks every run makes on itself; printed in one line and stored. `failed` says which, empty when sound.
struct SelfCheck {
  double closure_defect = 0;      ///< fraction of rays lost in rows before closure
  double reciprocity_chi2 = 0;    ///< reduced chi^2 of A_i F_ij - A_j F_ji
  double mean_chord_ratio = 0;    ///< measured / (4 V_void / S_total); 0 when the volume is not known
  std::int64_t leaked = 0;
  std::string failed;
};

/// View factors of an enclosure by Embree: hit counts of every surface.
HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options);

/// Total exchange-factor counts for grey surfaces: rays followed until absorbed (Russian roulette on the emissivity
/// of each surface hit); hits[k] counts absorptions. emissivity by surface number.
HitCounts trace_total_exchange(const Enclosure& enclosure, const std::vector<double>& emissivity,
                               const TraceOptions& options);

SelfCheck self_check(const Enclosure& enclosure, const HitCounts& counts);

}  // namespace granrad
