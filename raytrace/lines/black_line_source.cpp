#include "raytrace/lines/black_line_source.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/same_geometry.h"

namespace granrad {

namespace {

bool all_black(const RadiativeState& state) {
  return !state.implicit &&
         std::all_of(state.emissivity.begin(), state.emissivity.end(), [](double e) { return e == 1; }) &&
         std::none_of(state.excluded.begin(), state.excluded.end(), [](char dropped) { return dropped; });
}

}  // namespace

RadiativeHeat BlackLineSource::net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                        std::uint64_t update) {
  if (!all_black(state)) return otherwise_->net_heat(enclosure, state, update);
  LineOptions options = options_;
  options.seed += geometry_key(enclosure);
  RadiativeHeat result;
  LineReport report;
  std::vector<std::vector<double>> replicates;
  result.heat_W = sweep_black_heat(enclosure, state.emissive_power_W_m2, options, &result.standard_error_W,
                                   &report, &replicates);
  result.rays = report.ray_equivalents;
  const auto walls = static_cast<std::ptrdiff_t>(enclosure.sphere_count());
  const auto given = [walls](const std::vector<double>& heat) {
    return -std::accumulate(heat.begin() + walls, heat.end(), 0.0);
  };
  result.isothermal_wall_heat_W = given(result.heat_W);
  double squares = 0;
  for (const auto& heat : replicates) squares += std::pow(given(heat) - result.isothermal_wall_heat_W, 2);
  const double r = static_cast<double>(replicates.size());
  result.isothermal_wall_heat_error_W = std::sqrt(squares / (r * (r - 1)));
  return result;
}

}  // namespace granrad
