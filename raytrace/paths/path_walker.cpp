#include "raytrace/paths/path_walker.h"

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

/// What the second half of a long walk gave to whom.
struct PathWalker::Tail {
  static constexpr std::uint64_t length = most_surfaces_of_a_walk / 2;
  std::array<std::pair<std::int32_t, double>, length> given;
  std::size_t count = 0;
  double sum = 0;

  void add(std::int32_t surface, double amount) {
    given[count++] = {surface, amount};
    sum += amount;
  }
};

PathWalker::PathWalker(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
                       const PathOptions& options, std::uint64_t update)
    : tracer_(tracer),
      surfaces_(enclosure, state),
      starts_(enclosure, surfaces_, options.walks, options.wall_share),
      emitter_(enclosure),
      seed_(options.seed ^ 0x7061746873ull),
      update_(update),
      weighted_(surfaces_.smallest_absorptivity() < options.weighted_below) {
  const double range_W_m2 = surfaces_.power_range_W_m2(), densest = starts_.most_walks_per_m2();
  const double part = weighted_ ? surfaces_.smallest_absorptivity() : 1;
  quantum_W_ = heat_quantum_W(starts_.emission_area_m2() * range_W_m2,
                              densest > 0 ? part * range_W_m2 / (2 * densest) : 0);
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
  const std::int32_t start = starts_.surface_at(lattice.position(k));
  const auto [u0, u1, u2, u3] = lattice.uniforms(k);
  Emission ray = emitter_.emit(start, u0, u1, u2, u3);
  std::int32_t from = start;
  double weight = 1;
  Tail tail;
  for (std::uint64_t event = 0; event < (1ull << event_bits); ++event) {
    const Hit hit = tracer_.first_hit(ray.origin_m, ray.direction, from, ray.normal);
    ++tally.segments;
    from = hit.surface;
    if (from < 0) break;
    if (surfaces_.drops(from)) return;
    const double absorbed = surfaces_.absorptivity(from);
    if (absorbed == 1) return exchange(start, from, weight, tally);
    const auto bits = random_bits(seed_, update_, number << event_bits | event);
    if (weighted_ && absorbed > 0) {
      exchange(start, from, weight * absorbed, tally);
      if (event >= Tail::length) tail.add(from, weight * absorbed);
      weight *= 1 - absorbed;
      if (weight < roulette_below) {
        if (uniform(bits[2]) < 0.5) return;
        weight *= 2;
      }
      if (tail.count == Tail::length) {
        for (const auto& [surface, given] : tail.given)
          exchange(start, surface, weight * given / tail.sum, tally);
        return;
      }
    } else if (uniform(bits[2]) < absorbed) {
      return exchange(start, from, weight, tally);
    }
    ray = leave(hit, number, event, uniform(bits[0]), uniform(bits[1]), uniform(bits[3]));
  }
  ++tally.lost;
}

void PathWalker::exchange(std::int32_t start, std::int32_t end, double weight, PathTally& tally) const {
  if (start == end) return;
  const double heat = weight * starts_.area_per_walk_m2(start, end) *
                      (surfaces_.power_W_m2(start) - surfaces_.power_W_m2(end));
  const auto quanta = static_cast<Quanta>(std::round(heat / quantum_W_));
  tally.heat[end] += quanta;
  tally.heat[start] -= quanta;
}

}  // namespace granrad
