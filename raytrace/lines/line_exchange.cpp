#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/ranks/ranks.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/lines/line_chords.h"
#include "raytrace/lines/line_counts.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/stated_error.h"
#include "raytrace/wall_patches.h"

namespace granrad {

namespace {

/// Events between two merges: many enough to be worth a walk through all pairs.
constexpr double least_events = 1 << 22;
constexpr double merged_directions = 8;

struct LineSums {
  SymmetricCounts counts;
  double unit_m2;  ///< X = unit S
  MeanChord chord;
  std::int64_t leaked, ends, directions;  ///< of all replicates
};

/// Line ends expected in one direction, those on spheres seen from one side.
double ends_per_direction(const LineScene& scene) {
  double area = 0;
  for (const double r : scene.radius) area += pi * r * r;
  for (const auto& face : scene.faces) area += polygon_area(face.corners) / 4;
  return std::max(1.0, area / (scene.spacing * scene.spacing));
}

void consume(PairEvents& events, const std::int32_t* p, const std::int32_t* end) {
  while (p < end) {
    const std::int32_t n = p[1];
    for (std::int32_t k = 0; k < n; ++k) events.add(p[0], static_cast<std::uint32_t>(p[2 + k]));
    p += 2 + n;
  }
}

/// Directions of a replicate whose void length is measured: between walls all are alike, small periodic boxes
/// scatter.
int chord_directions(const LineScene& scene) {
  constexpr std::size_t spheres_wanted = 20000, most = 32;
  if (!scene.is_periodic()) return 1;
  return static_cast<int>(
      std::clamp<std::size_t>(spheres_wanted / std::max<std::size_t>(1, scene.x.size()), 1, most));
}

/// Directions between two merges of what was met: as many as the memory affords.
int directions_per_merge(const LineOptions& options, double ends, int directions) {
  const std::size_t affordable = options.memory_limit_bytes / 4 / PairCounts::bytes_per_event;
  const double events =
      std::min(static_cast<double>(affordable), std::max(least_events, merged_directions * ends));
  return static_cast<int>(std::clamp(events / ends, 1.0, static_cast<double>(directions)));
}

/// What the lines of the direction aimed at meet.
void meet(LinePass& pass, bool periodic, PairEvents& found) {
  if (periodic)
    pass.emit_pairs([&](std::int32_t surface, std::int32_t from) {
      found.add(surface, static_cast<std::uint32_t>(from) << line_run_bits);
    });
  else
    pass.emit_runs([&](const std::int32_t* p, const std::int32_t* end) { consume(found, p, end); });
}

LineSums sum_over_lines(const LineScene& scene, const LineOptions& options, int directions) {
  const std::size_t surfaces = scene.surface_count();
  std::vector<char> kind(surfaces, 1);
  std::fill_n(kind.begin(), scene.x.size(), 0);
  const int threads = line_threads(options.threads);
  const double ends = ends_per_direction(scene);
  const int block = directions_per_merge(options, ends, directions);
  PairCounts counts(std::move(kind), options.memory_limit_bytes / PairCounts::bytes_per_pair, block * ends,
                    threads);
  std::int64_t leaked = 0, leaked_in_chords = 0;
  std::vector<ChordSums> chords;
  const int chord_samples = std::min(directions, chord_directions(scene));
  RayMonitor monitor(options.watch, static_cast<double>(directions) * options.replicates);
#pragma omp parallel num_threads(threads) reduction(+ : leaked)
  {
    LinePass pass(scene);
    PairEvents& found = counts.events(omp_get_thread_num());
    for (int replicate = 0; replicate < options.replicates; ++replicate) {
      for (int from = 0; from < directions; from += block) {
        const RankPart mine = part_of_rank(std::min(directions - from, block));
#pragma omp for schedule(dynamic)
        for (std::int64_t k = from + mine.begin; k < from + mine.end; ++k) {
          if (!monitor.go_on(1)) continue;
          pass.aim(line_frame(options.seed, replicate, static_cast<int>(k), directions));
          meet(pass, scene.is_periodic(), found);
        }
        counts.merge(options.seed);
      }
#pragma omp single
      {
        const std::int64_t before = pass.leaked();
        for (int k = 0; k < chord_samples; ++k) {
          pass.aim(line_frame(options.seed, replicate, k * directions / chord_samples, directions));
          chords.push_back(chord_sums(pass));
        }
        leaked_in_chords += pass.leaked() - before;
      }
      counts.end_replicate();
    }
    leaked += pass.leaked();
  }
  monitor.throw_if_stopped();
  if (rank() > 0) leaked -= leaked_in_chords;  // every rank measures all of them
  sum_over_ranks({&leaked, 1});
  SymmetricCounts result = counts.finish();
  std::int64_t found = 0;
  for (auto c : result.count) found += c;
  const double swept = static_cast<double>(directions) * options.replicates;
  const auto row = result.pattern.row_begin.begin() + scene.open_surface;
  const bool closed = row[0] == row[1];
  return {std::move(result),
          2 * scene.spacing * scene.spacing / swept,
          closed ? mean_chord(chords, 0.5 * static_cast<double>(found), swept) : MeanChord{},
          leaked,
          found,
          std::int64_t{directions} * options.replicates};
}

/// The stated error, from the variances of pairs as if they were independent.
double relative_sum_error(const SymmetricCounts& counts, std::size_t spheres,
                          const StatedQuantity& quantity) {
  ParticleSums sums{std::vector<double>(spheres, 0), std::vector<double>(spheres, 0), {}};
  for (std::size_t i = 0; i < spheres; ++i) {
    double ends = 0;
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      ends += static_cast<double>(counts.count[k]);
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      if (quantity.counted[static_cast<std::size_t>(counts.pattern.column[k])]) {
        sums.value[i] += static_cast<double>(counts.count[k]) / ends;
        sums.variance[i] += counts.variance[k] / (ends * ends);
      }
  }
  return sums.relative_error(quantity.relative_to_rms);
}

LineSums sums_to_target(const LineScene& scene, const LineOptions& options, const StatedQuantity& quantity,
                        LineReport* report) {
  int directions = options.directions;
  std::vector<LineRound> rounds;
  std::int64_t ends = 0;
  for (;;) {
    LineSums result = sum_over_lines(scene, options, directions);
    ends += result.ends;
    const double error = relative_sum_error(result.counts, scene.x.size(), quantity);
    rounds.push_back({directions, error});
    if (options.target_error <= 0 || error <= options.target_error) {
      if (report)
        *report = {ends,
                   directions,
                   scene.spacing,
                   error,
                   result.counts.thinning_unit,
                   static_cast<int>(rounds.size())};
      return result;
    }
    directions = more_directions(rounds, options);
    refuse_wasted_lines(scene, options, directions);
  }
}

/// Variance factors by kind and size of the count, doubled: both counts of a pair are the same lines, and
/// merging them must not gain anything.
std::array<std::vector<double>, 4> variance_factors(const SymmetricCounts& counts, std::int32_t spheres) {
  constexpr std::size_t sizes = 40;
  std::array<std::array<double, sizes>, 4> found{}, binomial{};
  for (std::size_t i = 0; i + 1 < counts.pattern.row_begin.size(); ++i) {
    double ends = 0;
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      ends += static_cast<double>(counts.count[k]);
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k) {
      const double n = static_cast<double>(counts.count[k]);
      const auto kind = pair_kind(spheres, static_cast<std::int32_t>(i), counts.pattern.column[k]);
      const auto size =
          std::min<std::size_t>(std::bit_width(static_cast<std::uint64_t>(counts.count[k])) - 1, sizes - 1);
      found[kind][size] += 2 * counts.variance[k];
      binomial[kind][size] += n * (1 - n / ends);
    }
  }
  std::array<std::vector<double>, 4> factor;
  for (std::size_t kind = 0; kind < 4; ++kind)
    for (std::size_t size = 0; size < sizes; ++size)
      factor[kind].push_back(binomial[kind][size] > 0 ? found[kind][size] / binomial[kind][size]
                                                      : (size > 0 ? factor[kind].back() : 1));
  return factor;
}

}  // namespace

HitCounts sweep_view_factors(const Enclosure& enclosure, const LineOptions& options, LineReport* report) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc);
  refuse_wasted_lines(scene, options, options.directions);
  LineSums s = sums_to_target(scene, options, stated_quantity(enclosure, options.hot_walls), report);
  const SymmetricCounts& counts = s.counts;
  const std::size_t n = scene.surface_count();
  HitCounts hits;
  hits.area_m2 = surface_areas(enclosure);
  hits.leaked = s.leaked;
  hits.mean_chord_m = s.chord.value_m;
  hits.mean_chord_error_m = s.chord.standard_error_m;
  hits.launched.assign(n, 0);
  hits.spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  hits.variance_factor = variance_factors(counts, hits.spheres);
  hits.thinning_unit = counts.thinning_unit;
  hits.directions = s.directions;
  hits.pattern = counts.pattern;
  hits.hits = counts.count;
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      hits.launched[i] += counts.count[k];
  const auto open_row = static_cast<std::size_t>(hits.pattern.row_begin[n - 1]);
  hits.pattern.column.resize(open_row), hits.hits.resize(open_row);
  hits.pattern.row_begin[n] = hits.pattern.row_begin[n - 1];
  hits.launched[n - 1] = 0;
  return hits;
}

ExchangeAreas sweep_exchange_areas(const Enclosure& enclosure, const LineOptions& options, LineReport* report,
                                   ReplicateSamples* replicates, const WallPatches* patches) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc, patches);
  refuse_wasted_lines(scene, options, options.directions);
  const std::optional<Enclosure> cut = patches ? std::optional(patches->applied_to(enclosure)) : std::nullopt;
  const Enclosure& surfaces = cut ? *cut : enclosure;
  LineSums s = sums_to_target(scene, options, stated_quantity(surfaces, options.hot_walls), report);
  ExchangeAreas areas;
  areas.area_m2 = surface_areas(surfaces);
  areas.pattern = std::move(s.counts.pattern);
  areas.variance = std::move(s.counts.variance);
  for (double& v : areas.variance) v *= s.unit_m2 * s.unit_m2;
  if (replicates) {
    *replicates = std::move(s.counts.replicates);
    const auto scale = static_cast<float>(s.unit_m2 * options.replicates);
    for (auto& of_one : *replicates)
      for (auto& sample : of_one) sample.x_m2 *= scale;
  }
  areas.value.reserve(s.counts.count.size());
  for (const std::int64_t c : s.counts.count) areas.value.push_back(s.unit_m2 * static_cast<double>(c));
  return areas;
}

}  // namespace granrad
