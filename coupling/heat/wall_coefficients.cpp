#include "coupling/heat/wall_coefficients.h"

#include <cmath>

#include "coupling/heat/wall_area.h"

namespace granrad {

std::vector<std::size_t> hot_walls(const Bed& bed, const Box& region) {
  std::vector<std::size_t> walls;
  for (std::size_t w = 0; w < bed.walls.size(); ++w)
    if (conducts(bed.walls[w]) && area_inside(bed.walls[w], region) > 0) walls.push_back(w);
  return walls;
}

bool at_one_temperature(const Bed& bed, const std::vector<std::size_t>& walls) {
  constexpr double same_temperature = 1e-6;
  for (const std::size_t w : walls) {
    const double first = bed.walls[walls.front()].temperature_K;
    if (std::abs(bed.walls[w].temperature_K - first) > same_temperature * first) return false;
  }
  return true;
}

std::optional<WallCoefficients> wall_coefficients(const Bed& bed, const Box& region, const HeatPaths& heat_W,
                                                  double mean_temperature_K) {
  const auto walls = hot_walls(bed, region);
  if (walls.empty() || !at_one_temperature(bed, walls)) return {};
  double wall_area = 0;
  for (const std::size_t w : walls) wall_area += area_inside(bed.walls[w], region);
  const double difference = bed.walls[walls.front()].temperature_K - mean_temperature_K;
  if (std::abs(difference) < 1e-6) return {};
  const double per_watt = 1 / (difference * wall_area);
  return WallCoefficients{{heat_W.solid * per_watt, heat_W.gas * per_watt, heat_W.radiation * per_watt},
                          per_watt};
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
