#include "coupling/heat/wall_coefficients.h"

#include <cmath>

namespace granrad {

std::optional<WallCoefficients> wall_coefficients(const Bed& bed, const HeatPaths& heat_W,
                                                  double mean_temperature_K, double diameter_m,
                                                  double gas_conductivity_W_mK) {
  double wall_area = 0, weighted_temperature = 0;
  for (const auto& wall : bed.walls) {
    if (wall.role != WallRole::isothermal) continue;
    const double a = area(wall);
    wall_area += a;
    weighted_temperature += a * wall.temperature_K;
  }
  if (wall_area == 0) return {};
  const double difference = weighted_temperature / wall_area - mean_temperature_K;
  if (std::abs(difference) < 1e-6) return {};

  const double scale = 1 / (difference * wall_area);
  WallCoefficients result;
  result.h_W_m2K = {heat_W.solid * scale, heat_W.gas * scale, heat_W.radiation * scale};
  result.h_wp_W_m2K = result.h_W_m2K.total();
  if (gas_conductivity_W_mK > 0) result.Nu_d = result.h_wp_W_m2K * diameter_m / gas_conductivity_W_mK;
  return result;
}

double peclet_length(double velocity_m_s, double length_m, const Material& material) {
  return velocity_m_s * length_m * material.density_kg_m3 * material.specific_heat_J_kgK /
         material.conductivity_W_mK;
}

double peclet_modified(double peclet_length, double length_m, double diameter_m, const Material& material,
                       double gas_conductivity_W_mK) {
  const double ratio = material.conductivity_W_mK / gas_conductivity_W_mK * diameter_m / length_m;
  return peclet_length * ratio * ratio;
}

}  // namespace granrad
