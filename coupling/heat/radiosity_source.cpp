#include "coupling/heat/radiosity_source.h"

#include <cmath>
#include <utility>

#include "coupling/heat/crossing_error.h"
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

/// Samples between the rows kept, by their new numbers.
ReplicateSamples restricted(ReplicateSamples all, const std::vector<std::int32_t>& kept,
                            std::size_t surfaces) {
  if (kept.size() == surfaces) return all;
  std::vector<std::int32_t> number(surfaces, -1);
  for (std::size_t k = 0; k < kept.size(); ++k)
    number[static_cast<std::size_t>(kept[k])] = static_cast<std::int32_t>(k);
  for (auto& of_one : all) {
    std::erase_if(of_one, [&](const ReplicateSample& s) { return number[s.i] < 0 || number[s.j] < 0; });
    for (auto& s : of_one) s.i = number[s.i], s.j = number[s.j];
  }
  return all;
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
  ExchangeEstimate estimate = estimate_(enclosure, geometry_key(enclosure));
  lost_rays_ = estimate.lost_rays;
  areas_ = close(restricted(estimate.areas, kept), closure_, report_);
  replicates_ = restricted(std::move(estimate.replicates), kept, enclosure.surface_count());
  kept_ = std::move(kept);
  enclosure_ = enclosure;
  prepared_ = true;
}

double RadiositySource::wall_heat_error_W(const std::vector<double>& radiosity_W_m2,
                                          const std::vector<double>& emissivity,
                                          const std::vector<char>& gives) const {
  if (replicates_.size() < 2) return std::sqrt(crossing_variance(areas_, radiosity_W_m2, gives));
  const std::vector<double> one(gives.begin(), gives.end());
  return crossing_error_W(areas_, replicates_, radiosity_W_m2,
                          solve_radiosity(areas_, one, emissivity).radiosity_W_m2);
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
  result.lost_rays = std::exchange(lost_rays_, 0);
  result.closure_correction = report_.largest_correction;
  if (closure_ == Closure::row_sum)
    result.reciprocity_rms = reciprocity_rms(areas_, enclosure.sphere_count());
  result.heat_W.assign(enclosure.surface_count(), 0);
  const bool with_errors = !solved.standard_error_W.empty();
  if (with_errors) result.standard_error_W.assign(enclosure.surface_count(), 0);
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    result.heat_W[kept_[k]] = solved.heat_W[k];
    if (with_errors) result.standard_error_W[kept_[k]] = solved.standard_error_W[k];
    if (gives[k]) result.isothermal_wall_heat_W -= solved.heat_W[k];
  }
  if (with_errors)
    result.isothermal_wall_heat_error_W = wall_heat_error_W(solved.radiosity_W_m2, emissivity, gives);
  return result;
}

}  // namespace granrad
