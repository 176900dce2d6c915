#include "coupling/heat/radiosity_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "coupling/heat/crossing_error.h"
#include "coupling/heat/radiosity.h"
#include "raytrace/same_geometry.h"

namespace granrad {

namespace {

/// A sliver that walls cut out of each other leave, and no ray has met: at most this part of its wall is left out.
constexpr double most_left_out = 0.01;

bool sees_nothing(const ExchangeAreas& areas, std::int32_t s) {
  const auto row = areas.pattern.row_begin.begin() + s;
  return std::all_of(areas.value.begin() + row[0], areas.value.begin() + row[1],
                     [](double x) { return x == 0; });
}

/// Surfaces, walls in patches, that are not excluded.
std::vector<std::int32_t> surfaces_kept(const Enclosure& enclosure, const WallPatches& patches,
                                        const std::vector<char>& excluded, const ExchangeAreas& areas) {
  const auto spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  std::vector<std::int32_t> kept(enclosure.sphere_count());
  std::iota(kept.begin(), kept.end(), 0);
  const auto is_sliver = [&](std::int32_t p) {
    const Wall& wall = enclosure.walls[static_cast<std::size_t>(patches.wall(p))];
    return areas.area_m2[enclosure.sphere_count() + static_cast<std::size_t>(p)] <
               most_left_out * area(wall) &&
           sees_nothing(areas, spheres + p);
  };
  for (std::int32_t p = 0; p < patches.count(); ++p)
    if (!excluded[static_cast<std::size_t>(patches.wall(p))] && !is_sliver(p)) kept.push_back(spheres + p);
  kept.push_back(spheres + patches.count());
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

RadiositySource::RadiositySource(Estimate of_whole_walls, Closure closure)
    : estimate_([e = std::move(of_whole_walls)](const Enclosure& enclosure, const WallPatches&,
                                                std::uint64_t key) { return e(enclosure, key); }),
      closure_(closure) {}

void RadiositySource::prepare(const Enclosure& enclosure, const RadiativeState& state) {
  const std::size_t spheres = enclosure.sphere_count();
  std::vector<char> excluded, reflects;
  const bool cuts = cuts_walls_ && enclosure.periodic == std::array<bool, 3>{};
  for (std::size_t s = spheres; s < enclosure.open_surface(); ++s) {
    excluded.push_back(state.excluded[s]);
    reflects.push_back(cuts && !state.excluded[s] && state.emissivity[s] < 1);
  }
  if (prepared_ && excluded == excluded_ && reflects == reflects_ && same_geometry(enclosure, enclosure_))
    return;
  prepared_ = false;
  report_ = {};
  const bool any = std::find(reflects.begin(), reflects.end(), 1) != reflects.end();
  const WallPatches patches(enclosure.walls, any ? patch_length_m(enclosure, reflects) : 0, reflects);
  ExchangeEstimate estimate = estimate_(enclosure, patches, geometry_key(enclosure));
  lost_rays_ = estimate.lost_rays;
  const auto kept = surfaces_kept(enclosure, patches, excluded, estimate.areas);
  areas_ = close(granrad::restricted(estimate.areas, kept), closure_, report_);
  replicates_ = restricted(std::move(estimate.replicates), kept, spheres + patches.count() + 1);
  surface_ = kept;
  for (std::int32_t& s : surface_) {
    const std::int32_t patch = s - static_cast<std::int32_t>(spheres);
    if (patch >= 0)
      s = static_cast<std::int32_t>(spheres) +
          (patch < patches.count() ? patches.wall(patch) : static_cast<std::int32_t>(enclosure.walls.size()));
  }
  excluded_ = std::move(excluded);
  reflects_ = std::move(reflects);
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
  prepare(enclosure, state);
  std::vector<double> power, emissivity;
  std::vector<char> gives;
  for (const auto s : surface_) {
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
  for (std::size_t k = 0; k < surface_.size(); ++k) {
    const auto s = static_cast<std::size_t>(surface_[k]);
    result.heat_W[s] += solved.heat_W[k];
    if (with_errors)
      result.standard_error_W[s] = std::hypot(result.standard_error_W[s], solved.standard_error_W[k]);
    if (gives[k]) result.isothermal_wall_heat_W -= solved.heat_W[k];
  }
  if (with_errors)
    result.isothermal_wall_heat_error_W = wall_heat_error_W(solved.radiosity_W_m2, emissivity, gives);
  return result;
}

}  // namespace granrad
