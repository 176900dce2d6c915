#include "coupling/heat/heat_limits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/heat/heat_step.h"
#include "dem/base/constants.h"

namespace granrad {

namespace {

struct Bounds {
  double coldest_K, hottest_K;
};

Bounds bounds_of(const RadiativeState& state) {
  double low = INFINITY, high = 0;
  for (std::size_t s = 0; s < state.emissivity.size(); ++s) {
    if (!state.radiates(s)) continue;
    low = std::min(low, state.emissive_power_W_m2[s]);
    high = std::max(high, state.emissive_power_W_m2[s]);
  }
  const auto temperature = [](double power) { return std::pow(power / stefan_boltzmann, 0.25); };
  return {temperature(low), temperature(high)};
}

/// Heat that would just take each particle to a bound, W.
std::vector<double> room_W(const Bed& bed, const Enclosure& enclosure, double bound_K, double interval_s) {
  std::vector<double> room;
  for (const std::int32_t i : enclosure.particle)
    room.push_back(heat_capacity_J_K(bed, static_cast<std::size_t>(i)) * (bound_K - bed.temperature_K[i]) /
                   interval_s);
  return room;
}

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

double keep_within_bounds(const Bed& bed, const Enclosure& enclosure, const RadiativeState& state,
                          double interval_s, RadiativeHeat& heat) {
  const Bounds bounds = bounds_of(state);
  if (!(bounds.hottest_K > bounds.coldest_K)) return 0;
  const auto most = room_W(bed, enclosure, bounds.hottest_K, interval_s);
  const auto least = room_W(bed, enclosure, bounds.coldest_K, interval_s);
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
