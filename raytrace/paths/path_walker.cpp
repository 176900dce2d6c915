#include "raytrace/paths/path_walker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dem/base/random.h"

namespace granrad {

namespace {

constexpr int event_bits = 20;  // a walk that meets 2^20 surfaces is lost
constexpr double roulette_below = 0.2;
constexpr std::uint64_t spread_stream = 0x737072656164ull;

double uniform(std::uint32_t word) {
  return (word + 0.5) * 0x1p-32;
}

}  // namespace

/// What a walk gave to whom, apart from its last surface.
struct PathWalker::Given {
  struct Part {
    std::int32_t surface;
    double amount;
  };
  std::array<Part, most_surfaces_of_a_walk> to;  // not initialised: walks are short
  std::size_t count = 0;

  void add(std::int32_t surface, double amount) { to[count++] = {surface, amount}; }
};

PathWalker::PathWalker(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
                       const PathOptions& options, std::uint64_t update)
    : tracer_(tracer),
      surfaces_(enclosure, state),
      starts_(enclosure, surfaces_, options.walks, options.wall_share, tracer.is_closed()),
      flights_(enclosure, surfaces_, tracer, starts_.walks()),
      emitter_(enclosure),
      seed_(options.seed ^ 0x7061746873ull),
      update_(update),
      weighted_(surfaces_.smallest_absorptivity() < options.weighted_below) {
  const double range_W_m2 = surfaces_.power_range_W_m2(), densest = starts_.most_walks_per_m2();
  const double part = weighted_ ? surfaces_.smallest_absorptivity() : 1;
  quantum_W_ = heat_quantum_W(starts_.emission_area_m2() * range_W_m2,
                              densest > 0 ? part * range_W_m2 / (2 * densest) : 0);
  quanta_per_W_ = 1 / quantum_W_;  // a power of two
  constexpr double units_of_a_walk = 4096;
  if (range_W_m2 > 0)
    moments_per_W_ =
        units_of_a_walk * static_cast<double>(starts_.walks()) / (starts_.emission_area_m2() * range_W_m2);
}

/// To the nearest. Wide integers are made only where they are needed, for that takes a call.
Quanta PathWalker::in_quanta(double heat_W) const {
  const double quanta = heat_W * quanta_per_W_, rounded = quanta + std::copysign(0.5, quanta);
  return std::abs(rounded) < 0x1p62 ? static_cast<std::int64_t>(rounded) : static_cast<Quanta>(rounded);
}

void PathWalker::expect(std::int64_t walks, PathTally& tally) const {
  const double part = static_cast<double>(walks) / static_cast<double>(starts_.walks());
  for (const auto& [wall, sphere, area_m2] : flights_.pairs()) {
    const Quanta quanta = in_quanta(part * area_m2 * power_difference_W_m2(wall, sphere));
    tally.clear_heat[sphere] -= quanta;
    tally.clear_heat[wall] += quanta;
  }
}

/// Reflected diffusely where it was met, or sent out again from anywhere on the surface.
Emission PathWalker::leave(const Hit& hit, std::uint64_t number, std::uint64_t event, double u0, double u1,
                           double choice) const {
  if (choice >= surfaces_.spread_share(hit.surface))
    return {hit.position_m, cosine_direction(hit.normal, u0, u1), hit.normal};
  const auto place = random_bits(seed_ ^ spread_stream, update_, number << event_bits | event);
  return emitter_.emit(hit.surface, uniform(place[0]), uniform(place[1]), u0, u1);
}

void PathWalker::walk(const StartLattice& lattice, std::int64_t k, std::uint64_t number,
                      PathTally& tally) const {
  const std::int32_t start = tally.start = starts_.surface_at(lattice.position(k), tally.start);
  const auto [u0, u1, u2, u3] = lattice.uniforms(k);
  const Emission ray = emitter_.emit(start, u0, u1, u2, u3);
  if (flights_.idle())
    return follow(start, tracer_.first_hit(ray.origin_m, ray.direction, start, ray.normal), number, tally);
  const Hit hit =
      tracer_.first_hit_and_crossed(ray.origin_m, ray.direction, start, ray.normal, tally.crossed);
  tally.given_W = 0;
  follow(start, hit, number, tally);
  constexpr double most = 16384;  // so that sums of squares of 10^9 walks fit
  const auto units = [&](double given_W) {
    return static_cast<std::int64_t>(std::clamp(given_W * moments_per_W_, -most, most));
  };
  tally.moments.add(units(tally.given_W), units(fly_clear(start, tally)));
}

double PathWalker::fly_clear(std::int32_t start, PathTally& tally) const {
  const auto cross = [&](std::int32_t wall, std::int32_t sphere, double kept) {
    const double c = flights_.weight(wall, sphere);
    if (c == 0) return 0.0;
    const double heat =
        kept * c * starts_.area_per_walk_m2(wall, sphere) * power_difference_W_m2(wall, sphere);
    const Quanta quanta = in_quanta(heat);
    tally.clear_heat[sphere] += quanta;
    tally.clear_heat[wall] -= quanta;
    return heat;
  };
  if (!surfaces_.is_wall(start))
    return cross(tally.crossed.wall, start, surfaces_.absorptivity(tally.crossed.wall));
  double given_W = 0;
  for (const std::int32_t sphere : tally.crossed.spheres)
    given_W += cross(start, sphere, surfaces_.absorptivity(sphere));
  return given_W;
}

void PathWalker::follow(std::int32_t start, Hit hit, std::uint64_t number, PathTally& tally) const {
  double weight = 1;
  Given given;
  for (std::uint64_t event = 0; event < (1ull << event_bits); ++event) {
    ++tally.segments;
    const std::int32_t from = hit.surface;
    if (from < 0) break;
    if (surfaces_.drops(from)) return;
    const double absorbed = surfaces_.absorptivity(from);
    if (absorbed == 1) return exchange(start, from, weight, tally);
    const auto bits = random_bits(seed_, update_, number << event_bits | event);
    if (weighted_ && absorbed > 0) {
      exchange(start, from, weight * absorbed, tally);
      given.add(from, weight * absorbed);
      weight *= 1 - absorbed;
      if (weight < roulette_below) {
        const bool ends = uniform(bits[2]) < 0.5;
        share_out(start, ends ? weight : -weight, given, 0, tally);
        if (ends) return;
        weight *= 2;
      }
      if (given.count == given.to.size()) return share_out(start, weight, given, given.count / 2, tally);
    } else if (uniform(bits[2]) < absorbed) {
      return exchange(start, from, weight, tally);
    }
    const Emission ray = leave(hit, number, event, uniform(bits[0]), uniform(bits[1]), uniform(bits[3]));
    hit = tracer_.first_hit(ray.origin_m, ray.direction, from, ray.normal);
  }
  ++tally.lost;
}

void PathWalker::share_out(std::int32_t start, double weight, const Given& given, std::size_t from,
                           PathTally& tally) const {
  double sum = 0;
  for (std::size_t k = from; k < given.count; ++k) sum += given.to[k].amount;
  for (std::size_t k = from; k < given.count; ++k)
    exchange(start, given.to[k].surface, weight * given.to[k].amount / sum, tally);
}

void PathWalker::exchange(std::int32_t start, std::int32_t end, double weight, PathTally& tally) const {
  if (start == end) return;
  const double heat = weight * starts_.area_per_walk_m2(start, end) * power_difference_W_m2(start, end);
  const Quanta quanta = in_quanta(heat);
  tally.heat[end] += quanta;
  tally.heat[start] -= quanta;
  tally.given_W += heat * (surfaces_.is_wall(start) - surfaces_.is_wall(end));
}

}  // namespace granrad
