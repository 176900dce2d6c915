#include "coupling/heat/rough_contact.h"

#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

namespace {

constexpr double heat_ratio = 1.4, prandtl = 0.71;  // air

double asperities_W_m2K(const RoughSurface& s, double k, double pressure_over_hardness) {
  // sqrt 2 in slope and roughness cancel
  return 1.25 * k * (s.slope / s.roughness_m) * std::pow(pressure_over_hardness, 0.95);
}

double gap_W_m2K(const RoughSurface& s, double gas_W_mK, double pressure_over_hardness) {
  const double gap = 1.53 * std::sqrt(2.0) * s.roughness_m * std::pow(pressure_over_hardness, -0.097);
  const double jump = 2 * (2 - s.accommodation) / s.accommodation * 2 * heat_ratio / (1 + heat_ratio) *
                      s.mean_free_path_m / prandtl;
  return gas_W_mK / (gap + jump);
}

}  // namespace

double rough_contact_conductance(const RoughSurface& surface, double conductivity_W_mK, double gas_W_mK,
                                 double force_N, double contact_radius_m) {
  if (!(contact_radius_m > 0) || !(force_N > 0)) return 0;
  const double disc = pi * contact_radius_m * contact_radius_m;
  const double ratio =
      std::min(1.0, force_N / disc / surface.microhardness_Pa);  // beyond, the joint is closed
  const double joint =
      disc * (asperities_W_m2K(surface, conductivity_W_mK, ratio) + gap_W_m2K(surface, gas_W_mK, ratio));
  const double constriction = 2 * conductivity_W_mK * contact_radius_m;
  return 1 / (1 / constriction + 1 / joint);
}

double hertz_force_N(double modulus_Pa, double radius_m, double contact_radius_m) {
  return 4.0 / 3 * modulus_Pa * std::pow(contact_radius_m, 3) / radius_m;
}

}  // namespace granrad
