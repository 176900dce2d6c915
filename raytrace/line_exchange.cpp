#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/scene/constants.h"
#include "dem/scene/error.h"
#include "raytrace/line_chords.h"
#include "raytrace/line_counts.h"
#include "raytrace/line_pass.h"
#include "raytrace/line_plan.h"
#include "raytrace/line_sweep.h"

namespace granrad {

namespace {

/// Events between two merges: many enough to be worth a walk through all pairs.
constexpr double least_events = 1 << 22;
constexpr double merged_directions = 8;

struct Sweep {
  SymmetricCounts counts;
  double unit_m2;  ///< X = unit S
  MeanChord chord;
  std::int64_t leaked, ends;
};

double polygon_area(const std::vector<Vec3>& corners) {
  Vec3 twice{};
  for (std::size_t k = 2; k < corners.size(); ++k)
    twice += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
  return 0.5 * norm(twice);
}

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

Sweep sweep(const LineScene& scene, const LineOptions& options, int directions) {
  const std::size_t surfaces = scene.surface_count();
  std::vector<char> kind(surfaces, 1);
  std::fill_n(kind.begin(), scene.x.size(), 0);
  const int threads = line_threads(options.threads);
  const double ends = ends_per_direction(scene);
  const double affordable = static_cast<double>(options.memory_limit_bytes / 4 / PairCounts::bytes_per_event);
  const double events = std::min(affordable, std::max(least_events, merged_directions * ends));
  const int block = static_cast<int>(std::clamp(events / ends, 1.0, static_cast<double>(directions)));
  PairCounts counts(std::move(kind), options.memory_limit_bytes / PairCounts::bytes_per_pair, block * ends,
                    threads);
  std::int64_t leaked = 0;
  std::vector<ChordSums> chords;
#pragma omp parallel num_threads(threads) reduction(+ : leaked)
  {
    LinePass pass(scene);
    PairEvents& found = counts.events(omp_get_thread_num());
    for (int replicate = 0; replicate < options.replicates; ++replicate) {
      for (int from = 0; from < directions; from += block) {
#pragma omp for schedule(dynamic)
        for (int k = from; k < std::min(directions, from + block); ++k) {
          pass.aim(line_frame(options.seed, replicate, k, directions));
          pass.emit_runs([&](const std::int32_t* p, const std::int32_t* end) { consume(found, p, end); });
        }
        counts.merge(options.seed);
      }
#pragma omp single
      {
        pass.aim(line_frame(options.seed, replicate, 0, directions));
        chords.push_back(chord_sums(pass));
      }
      counts.end_replicate();
    }
    leaked += pass.leaked();
  }
  SymmetricCounts result = counts.finish();
  std::int64_t found = 0;
  for (auto c : result.count) found += c;
  const double swept = static_cast<double>(directions) * options.replicates;
  const auto row = result.pattern.row_begin.begin() + scene.open_surface;
  const bool closed = row[0] == row[1];
  return {std::move(result), 2 * scene.spacing * scene.spacing / swept,
          closed ? mean_chord(chords, 0.5 * static_cast<double>(found), swept) : MeanChord{}, leaked, found};
}

/// Standard error of the particles' sums over walls and surroundings, rms relative to their mean.
double relative_wall_sum_error(const SymmetricCounts& counts, std::size_t spheres) {
  double variance = 0, sum = 0;
  for (std::size_t i = 0; i < spheres; ++i)
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      if (static_cast<std::size_t>(counts.pattern.column[k]) >= spheres) {
        sum += static_cast<double>(counts.count[k]);
        variance += counts.variance[k];
      }
  return sum > 0 ? std::sqrt(variance * static_cast<double>(spheres)) / sum : 0;
}

Sweep sweep_to_target(const LineScene& scene, const LineOptions& options, LineReport* report) {
  int directions = options.directions;
  for (;;) {
    Sweep result = sweep(scene, options, directions);
    const double error = relative_wall_sum_error(result.counts, scene.x.size());
    if (options.target_error <= 0 || error <= options.target_error) {
      if (report) *report = {result.ends, directions, scene.spacing, error, result.counts.thinning_unit};
      return result;
    }
    directions = more_directions(directions, error, options.target_error);
  }
}

}  // namespace

HitCounts sweep_view_factors(const Enclosure& enclosure, const LineOptions& options, LineReport* report) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc);
  Sweep s = sweep_to_target(scene, options, report);
  const SymmetricCounts& counts = s.counts;
  const std::size_t n = scene.surface_count();
  HitCounts hits;
  hits.area_m2 = surface_areas(enclosure);
  hits.leaked = s.leaked;
  hits.mean_chord_m = s.chord.value_m;
  hits.mean_chord_error_m = s.chord.standard_error_m;
  hits.launched.assign(n, 0);
  hits.variance_factor.assign(n, 1);
  hits.pattern = counts.pattern;
  hits.hits = counts.count;
  for (std::size_t i = 0; i < n; ++i) {
    double variance = 0;
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k) {
      hits.launched[i] += counts.count[k];
      variance += counts.variance[k];
    }
    if (hits.launched[i] > 0) hits.variance_factor[i] = 2 * variance / static_cast<double>(hits.launched[i]);
  }
  const auto open_row = static_cast<std::size_t>(hits.pattern.row_begin[n - 1]);
  hits.pattern.column.resize(open_row), hits.hits.resize(open_row);
  hits.pattern.row_begin[n] = hits.pattern.row_begin[n - 1];
  hits.launched[n - 1] = 0;
  return hits;
}

ExchangeAreas sweep_exchange_areas(const Enclosure& enclosure, const LineOptions& options,
                                   LineReport* report) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc);
  Sweep s = sweep_to_target(scene, options, report);
  ExchangeAreas areas;
  areas.area_m2 = surface_areas(enclosure);
  areas.pattern = std::move(s.counts.pattern);
  areas.variance = std::move(s.counts.variance);
  for (double& v : areas.variance) v *= s.unit_m2 * s.unit_m2;
  areas.value.reserve(s.counts.count.size());
  for (const std::int64_t c : s.counts.count) areas.value.push_back(s.unit_m2 * static_cast<double>(c));
  return areas;
}

}  // namespace granrad
