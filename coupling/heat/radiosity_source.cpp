#include "coupling/heat/radiosity_source.h"

#include <cmath>

#include "coupling/heat/radiosity.h"
#include "dem/base/constants.h"
#include "raytrace/same_geometry.h"

namespace granrad {

namespace {

std::vector<std::int32_t> surfaces_kept(const std::vector<WallRole>& role) {
  std::vector<std::int32_t> kept;
  for (std::size_t s = 0; s < role.size(); ++s)
    if (role[s] != WallRole::excluded) kept.push_back(static_cast<std::int32_t>(s));
  return kept;
}

/// Rows and columns of the surfaces in `kept`.
ExchangeAreas restricted(const ExchangeAreas& all, const std::vector<std::int32_t>& kept) {
  if (kept.size() == all.area_m2.size()) return all;
  std::vector<std::int32_t> number(all.area_m2.size(), -1);
  for (std::size_t k = 0; k < kept.size(); ++k) number[kept[k]] = static_cast<std::int32_t>(k);
  ExchangeAreas part;
  part.pattern.row_begin = {0};
  for (const auto s : kept) {
    for (auto k = all.pattern.row_begin[s]; k < all.pattern.row_begin[s + 1]; ++k) {
      const auto column = number[all.pattern.column[k]];
      if (column < 0) continue;
      part.pattern.column.push_back(column);
      part.value.push_back(all.value[k]);
      if (!all.variance.empty()) part.variance.push_back(all.variance[k]);
    }
    part.pattern.row_begin.push_back(static_cast<std::int64_t>(part.pattern.column.size()));
    part.area_m2.push_back(all.area_m2[s]);
    if (!all.rays_per_m2.empty()) part.rays_per_m2.push_back(all.rays_per_m2[s]);
  }
  return part;
}

/// Emissivity in the balance of one radiosity per surface.
double effective_emissivity(WallRole role, double emissivity) {
  if (role == WallRole::adiabatic) return 0;
  return role == WallRole::open ? 1 : emissivity;
}

bool gives_heat(const Enclosure& enclosure, WallRole role, std::size_t surface) {
  return surface >= enclosure.sphere_count() && (role == WallRole::isothermal || role == WallRole::open);
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

void RadiositySource::prepare(const Enclosure& enclosure, const std::vector<WallRole>& role) {
  auto kept = surfaces_kept(role);
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
  prepare(enclosure, state.role);
  std::vector<double> power, emissivity;
  std::vector<char> gives;
  for (const auto s : kept_) {
    power.push_back(emissive_power(state.temperature_K[s]));
    emissivity.push_back(effective_emissivity(state.role[s], state.emissivity[s]));
    gives.push_back(gives_heat(enclosure, state.role[s], s));
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
