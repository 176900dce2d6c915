#include "raytrace/paths/path_starts.h"

#include <algorithm>
#include <cmath>

#include "dem/base/random.h"

namespace granrad {

PathSurfaces::PathSurfaces(const Enclosure& enclosure, const RadiativeState& state)
    : absorptivity_(state.emissivity),
      power_W_m2_(state.emissive_power_W_m2),
      relaxation_(state.relaxation),
      drops_(state.excluded),
      first_wall_(static_cast<std::int32_t>(enclosure.sphere_count())) {
  if (!state.implicit) return;
  for (std::size_t s = 0; s < absorptivity_.size(); ++s) {
    const double grey = absorptivity_[s], kept = state.kept_share(s) * grey;
    spread_share_.push_back(kept < grey ? (grey - kept) / (1 - kept) : 0);
    absorptivity_[s] = kept;
  }
}

double PathSurfaces::smallest_absorptivity() const {
  double smallest = 1;
  for (std::int32_t s = 0; s < count(); ++s)
    if (radiates(s)) smallest = std::min(smallest, absorptivity_[s]);
  return smallest;
}

double PathSurfaces::power_range_W_m2() const {
  double low = INFINITY, high = -INFINITY;
  for (std::int32_t s = 0; s < count(); ++s)
    if (radiates(s)) low = std::min(low, power_W_m2_[s]), high = std::max(high, power_W_m2_[s]);
  return high > low ? high - low : 0;
}

namespace {

/// Emission areas eps A of a kind of surface, and the mean and the variance over them of the emissive power.
struct Emitters {
  double area_m2 = 0, mean_W_m2 = 0, variance = 0;

  void add(double emission_area_m2, double power_W_m2) {  // Welford 1962, weighted
    area_m2 += emission_area_m2;
    const double off = power_W_m2 - mean_W_m2;
    mean_W_m2 += off * emission_area_m2 / area_m2;
    squares_ += emission_area_m2 * off * (power_W_m2 - mean_W_m2);
    variance = squares_ / area_m2;
  }

 private:
  double squares_ = 0;
};

/// Walks between walls and particles are worth the same wherever they start, so they are cheapest from the kind with less
/// area. Those between particles, and from particles to surroundings that start none, tell of differences between their
/// powers alone: with rho^2 = mean square of those over that between walls and particles, the sum of the variances of all
/// heats, X_wp / d_w + X_pp rho^2 / d_p (d: walks per area, X_pp / X_wp about A_p / A_w), is least where walks from
/// particles are rho A_p / A_w of those from walls.
double share_on_walls(const Emitters& particles, const Emitters& walls, double beyond_W_m2) {
  constexpr double least = 0.75;
  const auto square = [](double x) { return x * x; };
  const double among = particles.variance + square(beyond_W_m2 - particles.mean_W_m2);
  const double between = square(walls.mean_W_m2 - particles.mean_W_m2) + walls.variance + particles.variance;
  if (!(between > 0) || particles.area_m2 < walls.area_m2) return least;
  return std::max(least, 1 / (1 + std::sqrt(among / between) * particles.area_m2 / walls.area_m2));
}

}  // namespace

PathStarts::PathStarts(const Enclosure& enclosure, const PathSurfaces& surfaces, std::int64_t walks,
                       std::optional<double> wall_share, bool closed)
    : walks_(walks), walks_per_m2_(enclosure.surface_count(), 0.0) {
  const auto area = surface_areas(enclosure);
  const auto emitters = static_cast<std::int32_t>(enclosure.open_surface());
  Emitters kind[2];  // particles, walls
  for (std::int32_t s = 0; s < emitters; ++s)
    if (surfaces.radiates(s))
      kind[surfaces.is_wall(s)].add(surfaces.absorptivity(s) * area[s], surfaces.power_W_m2(s));
  emission_area_m2_ = kind[0].area_m2 + kind[1].area_m2;
  const double beyond =
      closed || !surfaces.radiates(emitters) ? kind[0].mean_W_m2 : surfaces.power_W_m2(emitters);
  const double on_walls = kind[0].area_m2 == 0   ? 1
                          : kind[1].area_m2 == 0 ? 0
                          : wall_share           ? *wall_share
                                                 : share_on_walls(kind[0], kind[1], beyond);
  const double share_per_m2[2] = {kind[0].area_m2 > 0 ? (1 - on_walls) / kind[0].area_m2 : 0,
                                  kind[1].area_m2 > 0 ? on_walls / kind[1].area_m2 : 0};
  double sum = 0;
  for (std::int32_t s = 0; s < emitters; ++s) {
    if (surfaces.radiates(s)) {
      const double share = share_per_m2[surfaces.is_wall(s)];
      walks_per_m2_[s] = share * static_cast<double>(walks);
      sum += share * surfaces.absorptivity(s) * area[s];
    }
    cumulative_.push_back(sum);
  }
  raise_to_needs(surfaces, area);
}

void PathStarts::raise_to_needs(const PathSurfaces& surfaces, const std::vector<double>& area) {
  std::vector<double> starts(cumulative_.size());
  double sum = 0;
  bool raised = false;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const auto number = static_cast<std::int32_t>(s);
    starts[s] = walks_per_m2_[s] * surfaces.absorptivity(number) * area[s];
    const double k = surfaces.relaxation(number), needed = walks_per_relaxation * k / (1 + k);
    if (surfaces.radiates(number) && starts[s] < needed) {
      starts[s] = needed;
      raised = true;
    }
    sum += starts[s];
  }
  if (!raised) return;
  walks_ = static_cast<std::int64_t>(std::ceil(sum));
  const double stretch = static_cast<double>(walks_) / sum;
  double before = 0;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    before += starts[s];
    cumulative_[s] = before;
    if (starts[s] > 0)
      walks_per_m2_[s] =
          stretch * starts[s] / (surfaces.absorptivity(static_cast<std::int32_t>(s)) * area[s]);
  }
}

double PathStarts::most_walks_per_m2() const {
  return *std::max_element(walks_per_m2_.begin(), walks_per_m2_.end());
}

std::int32_t PathStarts::surface_at(double u, std::int32_t before) const {
  const double all = cumulative_.back(), target = std::min(u * all, all * (1 - 0x1p-53));
  const auto b = static_cast<std::size_t>(before);
  if (target < cumulative_[b] && (b == 0 || target >= cumulative_[b - 1])) return before;
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  return static_cast<std::int32_t>(found - cumulative_.begin());
}

StartLattice::StartLattice(std::uint64_t seed, std::uint64_t update, int batch, std::int64_t count)
    : count_(count) {
  const std::uint64_t shifts = 1ull << 63;  // counters no walk reaches
  for (unsigned d = 0; d < 6; d += 2) {
    const auto u = random_uniform2(seed, update, shifts + 8 * static_cast<std::uint64_t>(batch) + d);
    shift_[d] = u[0];
    shift_[d + 1] = u[1];
  }
}

double StartLattice::position(std::int64_t k) const {
  return (static_cast<double>(k) + shift_[4]) / static_cast<double>(count_);
}

std::array<double, 4> StartLattice::uniforms(std::int64_t k) const {
  static constexpr double step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378086,
                                     0.53859725722361};
  std::array<double, 4> u;
  for (int d = 0; d < 4; ++d) {
    const double x = shift_[d] + static_cast<double>(k) * step[d];
    u[d] = x - static_cast<double>(static_cast<std::int64_t>(x));  // x >= 0: floor, without a call
  }
  return u;
}

}  // namespace granrad
