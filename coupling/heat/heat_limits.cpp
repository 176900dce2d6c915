#include "coupling/heat/heat_limits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/heat/heat_parts.h"
#include "dem/base/constants.h"

namespace granrad {

namespace {

/// Heat that would take each particle that far, W.
std::vector<double> heat_of_rise_W(const Bed& bed, const Enclosure& enclosure,
                                   const std::vector<double>& rise_K, double interval_s) {
  std::vector<double> heat_W;
  for (const std::int32_t i : enclosure.particle)
    heat_W.push_back(heat_capacity_J_K(bed, static_cast<std::size_t>(i)) *
                     rise_K[static_cast<std::size_t>(i)] / interval_s);
  return heat_W;
}

/// Middle rule steps of conduction alone.
class ConductionSteps {
 public:
  ConductionSteps(const Bed& bed, const Conductances& conductances, double step_s)
      : bed_(bed), conductances_(conductances), rise_per_W_(bed.size()), middle_K_(bed.size()) {
    for (std::size_t i = 0; i < bed.size(); ++i) rise_per_W_[i] = step_s / heat_capacity_J_K(bed, i);
  }
  void advance(std::vector<double>& T) {
    find_heats(T);
    for (std::size_t i = 0; i < T.size(); ++i) middle_K_[i] = T[i] + 0.5 * rise_per_W_[i] * heat_W_[i];
    find_heats(middle_K_);
    for (std::size_t i = 0; i < T.size(); ++i) T[i] += rise_per_W_[i] * heat_W_[i];
  }

 private:
  void find_heats(const std::vector<double>& T) {
    heat_W_.assign(T.size(), 0.0);
    add_conduction_W(bed_, conductances_, T, heat_W_);
  }

  const Bed& bed_;
  const Conductances& conductances_;
  std::vector<double> rise_per_W_, middle_K_, heat_W_;
};

void give_to_walls(const Enclosure& enclosure, const RadiativeState& state, double pool_W,
                   RadiativeHeat& heat) {
  std::vector<double> share(state.emissivity.size(), 0);
  const auto area = surface_areas(enclosure);
  for (std::size_t s = enclosure.sphere_count(); s < share.size(); ++s)
    if (state.radiates(s)) share[s] = state.emissivity[s] * area[s];
  const double all = std::accumulate(share.begin(), share.end(), 0.0);
  if (all == 0) share.back() = 1;  // nothing but the surroundings
  for (std::size_t s = 0; s < share.size(); ++s) heat.heat_W[s] += pool_W * share[s] / (all > 0 ? all : 1);
  heat.isothermal_wall_heat_W -= pool_W;
}

/// Shares what was taken among the particles by the room they have left.
void give_to_particles(const std::vector<double>& room, double pool_W, RadiativeHeat& heat) {
  double all = 0;
  for (std::size_t s = 0; s < room.size(); ++s) all += room[s] - heat.heat_W[s];
  for (std::size_t s = 0; s < room.size() && all != 0; ++s)
    heat.heat_W[s] += pool_W * (room[s] - heat.heat_W[s]) / all;
}

}  // namespace

TemperatureBounds temperature_bounds(const Bed& bed, const Conductances& conductances,
                                     const RadiativeState& state) {
  TemperatureBounds bounds{infinity, 0};
  const auto include = [&](double T) {
    bounds.coldest_K = std::min(bounds.coldest_K, T);
    bounds.hottest_K = std::max(bounds.hottest_K, T);
  };
  for (std::size_t s = 0; s < state.emissivity.size(); ++s)
    if (state.radiates(s)) include(std::pow(state.emissive_power_W_m2[s] / stefan_boltzmann, 0.25));
  for (const auto& g : conductances.particles)
    include(bed.temperature_K[g.i]), include(bed.temperature_K[g.j]);
  for (const auto& g : conductances.walls)
    include(bed.temperature_K[g.i]), include(bed.walls[g.wall].temperature_K);
  return bounds;
}

ConductedTemperatures conducted_temperatures(const Bed& bed, const Conductances& conductances, double dt_s,
                                             const TemperatureBounds& bounds) {
  constexpr double most_parts = 1e4;
  const std::vector<double> anything(bed.size(), infinity);
  ConductedTemperatures conducted{bed.temperature_K, anything, anything};
  const auto keep_room = [&](double passed) {
    for (std::size_t i = 0; i < bed.size(); ++i) {
      const double T = conducted.end_K[i];
      double& rise = conducted.most_rise_K[i];
      double& fall = conducted.most_fall_K[i];
      rise = std::max(0.0, std::min(rise, (bounds.hottest_K - T) / passed));
      fall = std::max(0.0, std::min(fall, (T - bounds.coldest_K) / passed));
    }
  };
  if (!conductances.particles.empty() || !conductances.walls.empty()) {
    const double parts = std::ceil(dt_s / conduction_step_limit_s(bed, conductances) * (1 + 1e-12));
    ConductionSteps steps(bed, conductances, dt_s / std::max(1.0, parts));
    for (double k = 1; k <= std::min(parts, most_parts); ++k) {
      steps.advance(conducted.end_K);
      keep_room(k / parts);
    }
  }
  keep_room(1);
  return conducted;
}

double keep_within_bounds(const Bed& bed, const ConductedTemperatures& conducted, const Enclosure& enclosure,
                          const RadiativeState& state, double interval_s, RadiativeHeat& heat) {
  const auto most = heat_of_rise_W(bed, enclosure, conducted.most_rise_K, interval_s);
  auto least = heat_of_rise_W(bed, enclosure, conducted.most_fall_K, interval_s);
  for (double& q : least) q = -q;
  double above = 0, below = 0, exchanged = 0;
  for (std::size_t s = 0; s < most.size(); ++s) {
    exchanged += std::abs(heat.heat_W[s]);
    const double kept = std::clamp(heat.heat_W[s], least[s], most[s]);
    (heat.heat_W[s] > kept ? above : below) += heat.heat_W[s] - kept;
    heat.heat_W[s] = kept;
  }
  const double moved = above - below;
  if (moved == 0) return 0;
  bool wall_radiates = heat.heat_W.back() != 0;
  for (std::size_t s = enclosure.sphere_count(); s < enclosure.open_surface(); ++s)
    wall_radiates = wall_radiates || state.radiates(s);
  if (wall_radiates)
    give_to_walls(enclosure, state, above + below, heat);
  else
    give_to_particles(above + below > 0 ? most : least, above + below, heat);
  return moved / exchanged;
}

}  // namespace granrad
