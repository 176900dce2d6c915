#include "coupling/heat/contact_conductance.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

double contact_area_m2(double radius_i_m, double radius_j_m, double distance_m) {
  const double sum = radius_i_m + radius_j_m, difference = radius_i_m - radius_j_m;
  if (distance_m >= sum) return 0;
  if (distance_m <= std::abs(difference)) {
    const double inner = std::min(radius_i_m, radius_j_m);
    return pi * inner * inner;
  }
  const double across = (sum - distance_m) * (sum + distance_m);
  const double along = (distance_m - difference) * (distance_m + difference);
  return pi * across * along / (4 * distance_m * distance_m);
}

double wall_contact_area_m2(double radius_m, double distance_m) {
  return distance_m >= radius_m ? 0 : pi * (radius_m - distance_m) * (radius_m + distance_m);
}

namespace {
/// Plane-strain modulus of two materials in series.
double effective_modulus(double modulus_a, double poisson_a, double modulus_b, double poisson_b) {
  return 1 / ((1 - poisson_a * poisson_a) / modulus_a + (1 - poisson_b * poisson_b) / modulus_b);
}
}  // namespace

double contact_conductivity_W_mK(const Material& a, const Material& b, double modulus_exponent) {
  const double k =
      2 * a.conductivity_W_mK * b.conductivity_W_mK / (a.conductivity_W_mK + b.conductivity_W_mK);
  const double soft =
      effective_modulus(a.youngs_modulus_Pa, a.poisson_ratio, b.youngs_modulus_Pa, b.poisson_ratio);
  const double real =
      effective_modulus(a.real_youngs_modulus_Pa, a.poisson_ratio, b.real_youngs_modulus_Pa, b.poisson_ratio);
  return 2 * k * std::pow(soft / real, modulus_exponent);
}

}  // namespace granrad
