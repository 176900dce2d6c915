#pragma once
#include "dem/bed/bed.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// Keeps what the heats of an interval make of the temperatures between the coldest and the hottest surface that
/// radiates: the heat of a sampled source is right in the mean, and by its noise may take a particle further than any
/// surface it exchanges with. What a particle has too much goes back to the walls that radiate, in proportion to
/// emissivity times area; without such walls to the particles that are still short of the bound. Sums are kept.
/// Returns the heat moved over the heat exchanged, 0 when nothing was beyond.
double keep_within_bounds(const Bed& bed, const Enclosure& enclosure, const RadiativeState& state,
                          double interval_s, RadiativeHeat& heat);

}  // namespace granrad
