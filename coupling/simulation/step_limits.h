#pragma once
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// The largest steps an explicit simulation of this case may take, s. Infinite where a process is not
/// modelled.
struct StepLimits {
  double impact_speed_m_s = 0;           ///< expected from feed, file and free fall
  double rayleigh_time_s, hertz_time_s;  ///< shortest over materials and radii
  double dem_s;                          ///< min(0.3 Rayleigh, 0.1 Hertz): the usual 10-30 % and 10 % rules
  double radiation_s;  ///< 0.1 radiation_time_constant_s of bed and feed: longer intervals are taken
                       ///< implicitly, to first order
  double motion_s;     ///< d / v: a particle moves its own diameter between radiation updates (advice only)
};

/// Seconds between radiation updates: as the scene says, or (auto) a whole part of the interval of rows, at most
/// limits.radiation_s and half the time in which a particle moves its diameter.
double radiation_interval_s(const Case& c, const StepLimits& limits);

/// Limits known from the scene alone; `bed` is the bed at time 0 (its particles add their radii and speeds).
/// The conduction limit needs contacts: see conduction_step_limit_s.
StepLimits step_limits(const Case& c, const Bed& bed);

}  // namespace granrad
