#pragma once
#include <vector>

#include "coupling/heat/conduction.h"
#include "dem/bed/bed.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// What no temperature of a bed without sources of its own may leave.
struct TemperatureBounds {
  double coldest_K, hottest_K;
};

/// The coldest and hottest of what radiates and of what conducts, at the powers of the state.
TemperatureBounds temperature_bounds(const Bed& bed, const Conductances& conductances,
                                     const RadiativeState& state);

/// Where conduction alone leads over an interval.
struct ConductedTemperatures {
  std::vector<double> end_K;  ///< at its end
  /// What heat held over the whole interval may add or take, K, so that no bound is passed on the way: the least over t
  /// of the distance to the bound at t over the part t / dt of the interval that has passed.
  std::vector<double> most_rise_K, most_fall_K;
};

/// By midpoint steps up to the limit of conduction with the conductances as they are; over the first 10^4 of them, beyond which
/// what is fast has come to rest.
ConductedTemperatures conducted_temperatures(const Bed& bed, const Conductances& conductances, double dt_s,
                                             const TemperatureBounds& bounds);

/// Keeps what the heats of an interval make of the temperatures, together with conduction, between the bounds: held heats do
/// not know what conduction does within the interval, and the heat of a sampled source is right in the mean, and by its noise
/// may take a particle further than any surface it exchanges with. What a particle has too much goes back to the walls that
/// radiate, in proportion to emissivity times area; without such walls to the particles that are still short of the bound.
/// Sums are kept. Returns the heat moved over the heat exchanged, 0 when nothing was beyond.
double keep_within_bounds(const Bed& bed, const ConductedTemperatures& conducted, const Enclosure& enclosure,
                          const RadiativeState& state, double interval_s, RadiativeHeat& heat);

}  // namespace granrad
