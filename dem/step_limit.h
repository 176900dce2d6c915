#pragma once
#include "dem/scene/material.h"

namespace granrad {

/// Rayleigh time, s (paper Eq. A.Rayleigh): pi r / (0.8766 + 0.1631 nu) sqrt(2 (1+nu) rho / Y).
double rayleigh_time_s(const Material& material, double radius_m);

/// Hertz collision time, s (paper Eq. A.Hertz): 2.87 (m*^2 / (R* Y*^2 v))^(1/5) for two equal spheres,
/// as LIGGGHTS computes it.
double hertz_time_s(const Material& material, double radius_m, double impact_speed_m_s);

}  // namespace granrad
