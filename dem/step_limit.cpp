#include "dem/step_limit.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

double rayleigh_time_s(const Material& m, double radius_m) {
  return pi * radius_m / (0.8766 + 0.1631 * m.poisson_ratio) *
         std::sqrt(2 * (1 + m.poisson_ratio) * m.density_kg_m3 / m.youngs_modulus_Pa);
}

double hertz_time_s(const Material& m, double radius_m, double impact_speed_m_s) {
  const double mass = sphere_volume(radius_m) * m.density_kg_m3;
  const double effective_mass = 0.5 * mass, effective_radius = 0.5 * radius_m;
  const double modulus = 0.5 * m.youngs_modulus_Pa / (1 - m.poisson_ratio * m.poisson_ratio);
  if (impact_speed_m_s <= 0) return infinity;
  return 2.87 *
         std::pow(effective_mass * effective_mass / (effective_radius * modulus * modulus * impact_speed_m_s),
                  0.2);
}

StepLimit step_limit(const Bed& bed, double fastest_m_s) {
  StepLimit limit;
  for (std::size_t i = 0; i < bed.size(); ++i) fastest_m_s = std::max(fastest_m_s, norm(bed.velocity_m_s[i]));
  std::vector<double> smallest(bed.materials.size(), infinity);
  for (std::size_t i = 0; i < bed.size(); ++i)
    smallest[bed.material[i]] = std::min(smallest[bed.material[i]], bed.radius_m[i]);
  for (std::size_t k = 0; k < smallest.size(); ++k) {
    if (!std::isfinite(smallest[k])) continue;
    limit.rayleigh_s = std::min(limit.rayleigh_s, rayleigh_time_s(bed.materials[k], smallest[k]));
    limit.hertz_s = std::min(limit.hertz_s, hertz_time_s(bed.materials[k], smallest[k], 2 * fastest_m_s));
  }
  limit.largest_step_s =
      std::min(StepLimit::rayleigh_share * limit.rayleigh_s, StepLimit::hertz_share * limit.hertz_s);
  return limit;
}

}  // namespace granrad
