#include "coupling/heat/radiosity_source.h"

#include <cmath>

#include "coupling/heat/radiosity.h"
#include "raytrace/same_geometry.h"

namespace granrad {

namespace {

std::vector<std::int32_t> surfaces_kept(const std::vector<char>& excluded) {
  std::vector<std::int32_t> kept;
  for (std::size_t s = 0; s < excluded.size(); ++s)
    if (!excluded[s]) kept.push_back(static_cast<std::int32_t>(s));
  return kept;
}

/// First-order variance of the heat that crosses from the surfaces that give to the others.
double crossing_variance(const ExchangeAreas& areas, const std::vector<double>& radiosity,
                         const std::vector<char>& gives) {
  double variance = 0;
  for (std::size_t i = 0; i < gives.size(); ++i) {
    if (!gives[i]) continue;
    for (auto k = areas.pattern.row_begin[i]; k < areas.pattern.row_begin[i + 1]; ++k) {
      const auto j = areas.pattern.column[k];
      const double difference = radiosity[j] - radiosity[i];
      if (!gives[j]) variance += areas.variance[k] * difference * difference;
    }
  }
  return variance;
}

}  // namespace

void RadiositySource::prepare(const Enclosure& enclosure, const std::vector<char>& excluded) {
  auto kept = surfaces_kept(excluded);
  if (prepared_ && kept == kept_ && same_geometry(enclosure, enclosure_)) return;
  prepared_ = false;
  report_ = {};
  areas_ = close(restricted(estimate_(enclosure, geometry_key(enclosure)), kept), closure_, report_);
  kept_ = std::move(kept);
  enclosure_ = enclosure;
  prepared_ = true;
}

RadiativeHeat RadiositySource::net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                        std::uint64_t /*update*/) {
  prepare(enclosure, state.excluded);
  std::vector<double> power, emissivity;
  std::vector<char> gives;
  for (const auto s : kept_) {
    const auto surface = static_cast<std::size_t>(s);
    power.push_back(state.emissive_power_W_m2[surface]);
    emissivity.push_back(state.kept_share(surface) * state.emissivity[surface]);
    gives.push_back(surface >= enclosure.sphere_count() && state.radiates(surface));
  }
  const RadiosityResult solved = solve_radiosity(areas_, power, emissivity);
  iterations_ = solved.iterations;

  RadiativeHeat result;
  result.closure_correction = report_.largest_correction;
  result.heat_W.assign(enclosure.surface_count(), 0);
  const bool with_errors = !solved.standard_error_W.empty();
  if (with_errors) result.standard_error_W.assign(enclosure.surface_count(), 0);
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    result.heat_W[kept_[k]] = solved.heat_W[k];
    if (with_errors) result.standard_error_W[kept_[k]] = solved.standard_error_W[k];
    if (gives[k]) result.isothermal_wall_heat_W -= solved.heat_W[k];
  }
  if (with_errors)
    result.isothermal_wall_heat_error_W = std::sqrt(crossing_variance(areas_, solved.radiosity_W_m2, gives));
  return result;
}

}  // namespace granrad
