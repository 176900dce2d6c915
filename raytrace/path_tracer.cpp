#include "raytrace/path_tracer.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/scene/constants.h"
#include "dem/scene/error.h"
#include "dem/scene/random.h"
#include "raytrace/emission.h"

namespace granrad {

namespace {

/// What a walk finds at each surface.
struct Surfaces {
  std::vector<double> absorptivity;  ///< 0: re-emits all
  std::vector<double> power_W_m2;    ///< sigma T^4
  std::vector<char> drops;           ///< excluded walls
  std::int32_t first_wall, surroundings;

  Surfaces(const Enclosure& enclosure, const RadiativeState& state)
      : first_wall(static_cast<std::int32_t>(enclosure.sphere_count())),
        surroundings(static_cast<std::int32_t>(enclosure.open_surface())) {
    for (std::size_t s = 0; s < state.role.size(); ++s) {
      const WallRole role = state.role[s];
      const bool black = role == WallRole::open || static_cast<std::int32_t>(s) == surroundings;
      absorptivity.push_back(role == WallRole::adiabatic ? 0 : black ? 1 : state.emissivity[s]);
      power_W_m2.push_back(emissive_power(state.temperature_K[s]));
      drops.push_back(role == WallRole::excluded);
    }
  }

  bool radiates(std::int32_t s) const { return absorptivity[s] > 0 && !drops[s]; }
  bool is_wall(std::int32_t s) const { return s >= first_wall; }

  double smallest_absorptivity() const {
    double smallest = 1;
    for (std::int32_t s = 0; s < surroundings; ++s)
      if (radiates(s)) smallest = std::min(smallest, absorptivity[s]);
    return smallest;
  }

  /// Range of the emissive powers that meet, W/m^2.
  double power_range() const {
    double low = INFINITY, high = -INFINITY;
    for (std::int32_t s = 0; s <= surroundings; ++s)
      if (radiates(s)) low = std::min(low, power_W_m2[s]), high = std::max(high, power_W_m2[s]);
    return high > low ? high - low : 0;
  }
};

/// Where walks start: a share on the walls, the rest on the particles, in each by emissivity times area.
class Starts {
 public:
  Starts(const Enclosure& enclosure, const Surfaces& surfaces, const PathOptions& options)
      : walks_per_m2_(enclosure.surface_count(), 0.0) {
    const auto area = surface_areas(enclosure);
    double total[2] = {0, 0};  // of particles, of walls
    for (std::int32_t s = 0; s < surfaces.surroundings; ++s)
      if (surfaces.radiates(s)) total[surfaces.is_wall(s)] += surfaces.absorptivity[s] * area[s];
    emission_area_m2_ = total[0] + total[1];
    const double wall_share = total[0] == 0 ? 1 : total[1] == 0 ? 0 : options.wall_share;
    const double share[2] = {1 - wall_share, wall_share};
    double sum = 0;
    for (std::int32_t s = 0; s < surfaces.surroundings; ++s) {
      const bool wall = surfaces.is_wall(s);
      if (surfaces.radiates(s) && share[wall] > 0) {
        walks_per_m2_[s] = share[wall] * static_cast<double>(options.walks) / total[wall];
        sum += share[wall] / total[wall] * surfaces.absorptivity[s] * area[s];
      }
      cumulative_.push_back(sum);
    }
  }

  bool none() const { return emission_area_m2_ == 0; }
  double emission_area_m2() const { return emission_area_m2_; }

  /// Surface at the fraction u in [0, 1) of all starts.
  std::int32_t surface_at(double u) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u * cumulative_.back());
    return static_cast<std::int32_t>(found - cumulative_.begin());
  }

  /// Exchange area that a whole walk between i and j stands for, m^2: 1/(1/g_i + 1/g_j).
  double area_per_walk_m2(std::int32_t i, std::int32_t j) const {
    return 1 / (walks_per_m2_[i] + walks_per_m2_[j]);
  }

 private:
  std::vector<double> cumulative_;
  std::vector<double> walks_per_m2_;  ///< 1/g, per m^2 of emissivity times area
  double emission_area_m2_ = 0;
};

/// Starts of one batch: a lattice of rank 1 (fractional multiples of powers of the root of x^5 = x + 1) over
/// point and direction, ordered by surface, moved by one random shift.
class StartLattice {
 public:
  StartLattice(std::uint64_t seed, std::uint64_t update, int batch, std::int64_t count) : count_(count) {
    for (int d = 0; d < 6; d += 2) {
      const auto u = random_uniform2(seed, update, (1ull << 63) + 8 * batch + d);
      shift_[d] = u[0];
      shift_[d + 1] = u[1];
    }
  }
  double position(std::int64_t k) const {
    return (static_cast<double>(k) + shift_[4]) / static_cast<double>(count_);
  }
  double uniform(std::int64_t k, int dimension) const {
    static constexpr double step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378086,
                                       0.53859725722361};
    const double x = shift_[dimension] + static_cast<double>(k) * step[dimension];
    return x - std::floor(x);
  }

 private:
  std::int64_t count_;
  double shift_[6];
};

/// Heats of one batch, in quanta.
struct Tally {
  std::vector<std::int64_t> heat;
  std::int64_t segments = 0, lost = 0;
};

class Walker {
 public:
  Walker(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
         const PathOptions& options, std::uint64_t update)
      : tracer_(tracer),
        surfaces_(enclosure, state),
        starts_(enclosure, surfaces_, options),
        emitter_(enclosure),
        seed_(options.seed ^ 0x7061746873ull),
        update_(update),
        weighted_(surfaces_.smallest_absorptivity() < options.weighted_below) {
    // A power of two: heats in quanta become doubles exactly, and their sum as doubles is 0 exactly.
    const double bound = starts_.emission_area_m2() * surfaces_.power_range();
    quantum_W_ = bound > 0 ? std::exp2(std::ceil(std::log2(bound)) - 50) : 1;
  }

  const Surfaces& surfaces() const { return surfaces_; }
  bool nothing_emits() const { return starts_.none(); }
  double quantum_W() const { return quantum_W_; }

  Tally run_batch(int batch, std::int64_t first, std::int64_t count) const {
    Tally tally;
    tally.heat.assign(surfaces_.power_W_m2.size(), 0);
    const StartLattice lattice(seed_, update_, batch, count);
    for (std::int64_t k = 0; k < count; ++k) walk(lattice, k, static_cast<std::uint64_t>(first + k), tally);
    return tally;
  }

 private:
  static constexpr int event_bits = 20;  ///< a walk that meets 2^20 surfaces is lost
  static constexpr double roulette_below = 0.2;

  void walk(const StartLattice& lattice, std::int64_t k, std::uint64_t number, Tally& tally) const {
    const std::int32_t start = starts_.surface_at(lattice.position(k));
    Emission ray = emitter_.emit(start, lattice.uniform(k, 0), lattice.uniform(k, 1), lattice.uniform(k, 2),
                                 lattice.uniform(k, 3));
    std::int32_t from = start;
    double weight = 1;
    for (std::uint64_t event = 0; event < (1ull << event_bits); ++event) {
      const Hit hit = tracer_.first_hit(ray.origin_m, ray.direction, from);
      ++tally.segments;
      from = hit.surface;
      if (from < 0) break;
      if (surfaces_.drops[from]) return;
      const double absorbed = surfaces_.absorptivity[from];
      if (absorbed == 1) return exchange(start, from, weight, tally);
      const auto bits = random_bits(seed_, update_, number << event_bits | event);
      const auto uniform = [&](int word) { return (bits[word] + 0.5) * 0x1p-32; };
      if (weighted_ && absorbed > 0) {
        exchange(start, from, weight * absorbed, tally);
        weight *= 1 - absorbed;
        if (weight < roulette_below) {
          if (uniform(2) < 0.5) return;
          weight *= 2;
        }
      } else if (uniform(2) < absorbed) {
        return exchange(start, from, weight, tally);
      }
      ray = {hit.position_m, cosine_direction(hit.normal, uniform(0), uniform(1))};
    }
    ++tally.lost;
  }

  void exchange(std::int32_t start, std::int32_t end, double weight, Tally& tally) const {
    if (start == end) return;
    const double heat = weight * starts_.area_per_walk_m2(start, end) *
                        (surfaces_.power_W_m2[start] - surfaces_.power_W_m2[end]);
    const auto quanta = std::llround(heat / quantum_W_);
    tally.heat[end] += quanta;
    tally.heat[start] -= quanta;
  }

  const EmbreeTracer& tracer_;
  Surfaces surfaces_;
  Starts starts_;
  Emitter emitter_;
  std::uint64_t seed_, update_;
  bool weighted_;
  double quantum_W_;
};

/// Sum over the batches and the standard error of that sum, in quanta.
template <class Value>
std::pair<std::int64_t, double> total_and_error(Value value_of_batch) {
  std::int64_t total = 0;
  for (int b = 0; b < path_batches; ++b) total += value_of_batch(b);
  const double mean = static_cast<double>(total) / path_batches;
  double squares = 0;
  for (int b = 0; b < path_batches; ++b) {
    const double d = static_cast<double>(value_of_batch(b)) - mean;
    squares += d * d;
  }
  return {total, std::sqrt(squares * path_batches / (path_batches - 1))};
}

RadiativeHeat assemble(const Walker& walker, const std::vector<Tally>& batches) {
  const Surfaces& surfaces = walker.surfaces();
  const double quantum = walker.quantum_W();
  RadiativeHeat result;
  std::vector<std::int64_t> given(path_batches, 0);
  for (std::int32_t s = 0; s <= surfaces.surroundings; ++s) {
    const auto [total, error] = total_and_error([&](int b) { return batches[b].heat[s]; });
    result.heat_W.push_back(static_cast<double>(total) * quantum);
    result.standard_error_W.push_back(error * quantum);
    if (surfaces.is_wall(s))
      for (int b = 0; b < path_batches; ++b) given[b] -= batches[b].heat[s];
  }
  const auto [total, error] = total_and_error([&](int b) { return given[b]; });
  result.isothermal_wall_heat_W = static_cast<double>(total) * quantum;
  result.isothermal_wall_heat_error_W = error * quantum;
  for (const auto& batch : batches) result.rays += batch.segments;
  return result;
}

}  // namespace

RadiativeHeat trace_paths(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
                          const PathOptions& options, std::uint64_t update) {
  if (options.walks < 2 * path_batches)
    throw InputError(
        fmt::format("radiation.rays = {} (paths need at least {} walks an update to know their "
                    "error); 10000 is usual",
                    options.walks, 2 * path_batches));
  const Walker walker(enclosure, tracer, state, options, update);
  std::vector<Tally> batches(path_batches);
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int b = 0; b < path_batches; ++b) {
    const std::int64_t first = options.walks * b / path_batches,
                       last = options.walks * (b + 1) / path_batches;
    batches[b] = walker.run_batch(b, first, walker.nothing_emits() ? 0 : last - first);
  }
  std::int64_t lost = 0;
  for (const auto& batch : batches) lost += batch.lost;
  if (static_cast<double>(lost) > 1e-3 * static_cast<double>(options.walks))
    throw NumericalError(
        fmt::format("paths: {} of {} walks leaked or did not end (walls that do not close, or "
                    "emissivities near 0)",
                    lost, options.walks));
  return assemble(walker, batches);
}

}  // namespace granrad
