#include "raytrace/paths/path_tracer.h"

#include <fmt/format.h>
#include <omp.h>

#include <cmath>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "raytrace/paths/path_starts.h"
#include "raytrace/rays/emission.h"

namespace granrad {

namespace {

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
        starts_(enclosure, surfaces_, options.walks, options.wall_share),
        emitter_(enclosure),
        seed_(options.seed ^ 0x7061746873ull),
        update_(update),
        weighted_(surfaces_.smallest_absorptivity() < options.weighted_below) {
    // A power of two: heats in quanta become doubles exactly, and their sum as doubles is 0 exactly.
    const double bound = starts_.emission_area_m2() * surfaces_.power_range_W_m2();
    quantum_W_ = bound > 0 ? std::exp2(std::ceil(std::log2(bound)) - 50) : 1;
  }

  const PathSurfaces& surfaces() const { return surfaces_; }
  bool nothing_emits() const { return starts_.emission_area_m2() == 0; }
  double quantum_W() const { return quantum_W_; }

  Tally run_batch(int batch, std::int64_t first, std::int64_t count) const {
    Tally tally;
    tally.heat.assign(surfaces_.count(), 0);
    const StartLattice lattice(seed_, update_, batch, count);
    for (std::int64_t k = 0; k < count; ++k) walk(lattice, k, static_cast<std::uint64_t>(first + k), tally);
    return tally;
  }

 private:
  static constexpr int event_bits = 20;  ///< a walk that meets 2^20 surfaces is lost
  static constexpr double roulette_below = 0.2;

  void walk(const StartLattice& lattice, std::int64_t k, std::uint64_t number, Tally& tally) const {
    const std::int32_t start = starts_.surface_at(lattice.position(k));
    const auto [u0, u1, u2, u3] = lattice.uniforms(k);
    Emission ray = emitter_.emit(start, u0, u1, u2, u3);
    std::int32_t from = start;
    double weight = 1;
    for (std::uint64_t event = 0; event < (1ull << event_bits); ++event) {
      const Hit hit = tracer_.first_hit(ray.origin_m, ray.direction, from, ray.normal);
      ++tally.segments;
      from = hit.surface;
      if (from < 0) break;
      if (surfaces_.drops(from)) return;
      const double absorbed = surfaces_.absorptivity(from);
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
      ray = {hit.position_m, cosine_direction(hit.normal, uniform(0), uniform(1)), hit.normal};
    }
    ++tally.lost;
  }

  void exchange(std::int32_t start, std::int32_t end, double weight, Tally& tally) const {
    if (start == end) return;
    const double heat = weight * starts_.area_per_walk_m2(start, end) *
                        (surfaces_.power_W_m2(start) - surfaces_.power_W_m2(end));
    const auto quanta = std::llround(heat / quantum_W_);
    tally.heat[end] += quanta;
    tally.heat[start] -= quanta;
  }

  const EmbreeTracer& tracer_;
  PathSurfaces surfaces_;
  PathStarts starts_;
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
  const PathSurfaces& surfaces = walker.surfaces();
  const double quantum = walker.quantum_W();
  RadiativeHeat result;
  std::vector<std::int64_t> given(path_batches, 0);
  for (std::int32_t s = 0; s < surfaces.count(); ++s) {
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
