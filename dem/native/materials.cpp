#include "dem/native/materials.h"

#include <cmath>

#include "dem/base/constants.h"

namespace granrad::native {
namespace {

HertzMindlin<double> coefficients(const Material& a, const Material& b, double effective_radius,
                                  double effective_mass) {
  const auto compliance = [](const Material& m) {
    return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus_Pa;
  };
  const auto shear_compliance = [](const Material& m) {
    return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.youngs_modulus_Pa;
  };
  const double young = 1 / (compliance(a) + compliance(b));
  const double shear = 1 / (shear_compliance(a) + shear_compliance(b));
  const double log_e = 0.5 * (std::log(a.restitution) + std::log(b.restitution));
  const double damping = -2 * std::sqrt(5.0 / 6.0) * log_e / std::sqrt(log_e * log_e + pi * pi);
  HertzMindlin<double> c;
  c.effective_radius = effective_radius;
  c.normal = 4.0 / 3.0 * young;
  c.tangential = 8 * shear;
  c.normal_damping = damping * std::sqrt(2 * effective_mass * young);
  c.tangential_damping = damping * std::sqrt(8 * effective_mass * shear);
  c.friction = std::sqrt(a.friction * b.friction);
  c.rolling = std::sqrt(a.rolling_friction * b.rolling_friction) * effective_radius;
  return c;
}

}  // namespace

HertzMindlin<double> pair_coefficients(const ContactBody& a, const ContactBody& b) {
  return coefficients(*a.material, *b.material, a.radius_m * b.radius_m / (a.radius_m + b.radius_m),
                      a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg));
}

HertzMindlin<double> wall_coefficients(const ContactBody& body) {
  return coefficients(*body.material, *body.material, body.radius_m, body.mass_kg);
}

}  // namespace granrad::native
