#pragma once
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// Means over the particles in equal slices of a region along one axis.
struct Profile {
  std::vector<double> position_m;  ///< middles of the slices
  std::vector<double> solid_fraction, temperature_K, velocity_m_s, radiative_heat_W;  ///< velocity: downwards
};

/// Profile of one or more beds (their mean, empty slices as nan). Volumes are cut at slice borders exactly
/// across the axis of the slices: a sphere contributes to each slice the part of it that lies inside.
Profile profile(const std::vector<Bed>& beds, const Box& region, int axis, int slices);

}  // namespace granrad
