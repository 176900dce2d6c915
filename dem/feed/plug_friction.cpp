#include "dem/feed/plug_friction.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

double PlugFriction::loss_m_s(double age_s) const {
  return deceleration_m_s2 * cooling_time_s * age_s / (cooling_time_s + age_s);
}

double PlugFriction::mean_loss_m_s(double residence_s) const {
  const double x = residence_s / cooling_time_s;
  constexpr double series_below = 1e-4;  // 1 - ln(1 + x)/x loses digits there
  const double mean = x < series_below ? x / 2 : 1 - std::log1p(x) / x;
  return deceleration_m_s2 * cooling_time_s * mean;
}

PlugFriction plug_friction(const PlugFrictionInput& in) {
  const double phi = in.solid_fraction, e = in.restitution;
  const double temperature = 2.0 / 3.0 * in.transverse_velocity_std_m_s * in.transverse_velocity_std_m_s;
  const double contact = (1 - phi / 2) / ((1 - phi) * (1 - phi) * (1 - phi));
  const double collisions_1_s = 24 * phi * contact * std::sqrt(temperature / pi) / in.diameter_m;
  constexpr double never_s = 1e6;
  PlugFriction result;
  result.cooling_time_s = std::min(never_s, 6 / std::max(1e-300, (1 - e * e) * collisions_1_s));
  result.deceleration_m_s2 =
      in.friction * in.perimeter_over_area_1_m * (1 + 2 * (1 + e) * phi * contact) * temperature;
  return result;
}

}  // namespace granrad
