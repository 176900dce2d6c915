#pragma once
#include "dem/bed/material.h"

namespace granrad {

/// Rayleigh time, s (paper Eq. A.Rayleigh): pi r / (0.8766 + 0.1631 nu) sqrt(2 (1+nu) rho / Y).
/// The paper's 6.09e-5 s is d = 0.8 mm, Y = 5e6 Pa; d = 0.4 mm has 3.04e-5 s.
double rayleigh_time_s(const Material& material, double radius_m);

/// Hertz collision time, s (paper Eq. A.Hertz): 2.87 (m*^2 / (R* Y*^2 v))^(1/5) for two equal spheres.
/// Infinite at rest.
double hertz_time_s(const Material& material, double radius_m, double impact_speed_m_s);

/// Shares of the two times a step may take. The paper allows 10-30 % of Rayleigh and at most 10 % of Hertz.
inline constexpr double rayleigh_share = 0.3, hertz_share = 0.1;

}  // namespace granrad
