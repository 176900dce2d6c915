#include "dem/step_limit.h"

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

}  // namespace granrad
