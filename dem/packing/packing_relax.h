#pragma once
#include <vector>

#include "dem/packing/packing.h"

namespace granrad {

/// Moves spheres apart: FIRE on the energy, sum of 1/2 overlap^2, of spheres `inflation` times too large (and
/// of their overlap with the walls), until every true gap is half of what the inflation asks for. Returns the
/// largest overlap of the true spheres left, over the smaller radius: < 0 when all are apart, > 0 when it
/// gave up (jammed).
double relax_overlaps(const PackingBox& where, const std::vector<double>& radius_m, double inflation,
                      std::vector<Vec3>& position);

}  // namespace granrad
