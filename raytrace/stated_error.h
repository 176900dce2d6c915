#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

/// What a trace states its error of: the fractions p_i of a particle's radiation that end on some walls.
///   particle-wall sums: all walls and surroundings; rms error over the particles relative to the mean p;
///   particle fluxes: the hot walls of a bed heated by them (equal black walls, cold particles: the flux
///   received by particle i is E p_i); rms error relative to the rms p.
struct StatedQuantity {
  std::vector<char> counted;     ///< [surfaces]
  bool relative_to_rms = false;  ///< fluxes
};

/// `hot_walls`: surface numbers; empty: particle-wall sums. Throws InputError for a surface that is not a
/// wall.
StatedQuantity stated_quantity(const Enclosure& enclosure, const std::vector<std::int32_t>& hot_walls);

/// p_i of every particle as closed exchange areas will have it, and its variance. Both ends count: a pair is
/// merged with weights w_ij = (n_i / A_i) / (n_i / A_i + n_j / A_j) and 1 - w_ij, and closure divides by the
/// row sum, so that to first order, with c_ij = [j counted] - p_i,
///   var p_i = s / n_i (sum_j (c w)^2 F - (sum_j c w F)^2) + 1 / A_i^2 sum_j (c_ij (1 - w_ij))^2 var X_ji,
/// s = sum_variance_factor; the first term from the rays of i (multinomial), the second from those of the
/// others.
struct ParticleSums {
  std::vector<double> value, variance;
  std::vector<double> of_row;  ///< part of the variance that the rest of the row brings in, by closure
  /// sqrt(sum of variances) over sqrt(N) mean p, or over sqrt(sum of p^2); 0 when all p are zero.
  double relative_error(bool relative_to_rms) const;
};
ParticleSums particle_sums(const HitCounts& counts, const StatedQuantity& quantity);

}  // namespace granrad
