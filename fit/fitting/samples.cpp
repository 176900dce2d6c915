#include "fit/fitting/samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "dem/bed/cell_grid.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/exact.h"
#include "raytrace/unobstructed_pair.h"

namespace granrad {

namespace {

/// Hits of row i that ended on surface j, and their variance.
struct Count {
  double hits = 0, variance = 0;
};

Count count_between(const HitCounts& counts, std::size_t i, std::size_t j) {
  const auto first = counts.pattern.column.begin() + counts.pattern.row_begin[i];
  const auto last = counts.pattern.column.begin() + counts.pattern.row_begin[i + 1];
  const auto at = std::lower_bound(first, last, static_cast<std::int32_t>(j));
  if (at == last || *at != static_cast<std::int32_t>(j)) return {};
  const auto k = at - counts.pattern.column.begin();
  const double hits = static_cast<double>(counts.hits[k]), launched = static_cast<double>(counts.launched[i]);
  return {hits, count_variance_factor(counts, i, k) * hits * (1 - hits / launched)};
}

/// Adds the merged estimate of F_ij.
void add_sample(const HitCounts& counts, std::size_t i, std::size_t j, double distance, double unobstructed,
                DistanceSamples& samples) {
  const double weight = static_cast<double>(counts.launched[i]) / counts.area_m2[i] +
                        static_cast<double>(counts.launched[j]) / counts.area_m2[j];
  const Count ij = count_between(counts, i, j), ji = count_between(counts, j, i);
  const double per_hit = 1 / (weight * counts.area_m2[i]);
  samples.distance.push_back(distance);
  samples.factor.push_back((ij.hits + ji.hits) * per_hit);
  samples.variance.push_back((ij.variance + ji.variance) * per_hit * per_hit);
  samples.unobstructed.push_back(unobstructed);
}

void refuse_unfit(const Enclosure& enclosure, const HitCounts& counts, const std::string& origin) {
  std::vector<std::string> problems;
  const auto problem = [&](const std::string& cause, const std::string& advice) {
    problems.push_back(advised(origin + ": " + cause, advice));
  };
  if (enclosure.sphere_count() < 2)
    problem(fmt::format("{} spheres (a pair function needs at least two)", enclosure.sphere_count()),
            "trace a bed");
  else if (const auto [low, high] = std::minmax_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
           *high > 1.01 * *low)
    problem(fmt::format("radii = {:.4g} to {:.4g} m (correlations hold for equal spheres, within 1 %)", *low,
                        *high),
            "fit sizes of one kind");
  if (counts.launched.size() != enclosure.surface_count())
    problem(fmt::format("{} rows of counts for {} surfaces (the file is inconsistent)",
                        counts.launched.size(), enclosure.surface_count()),
            "trace it again");
  for (std::size_t i = 0; problems.empty() && i < enclosure.sphere_count(); ++i)
    if (counts.launched[i] <= 0)
      problem(fmt::format("sphere {} launched no rays (nothing is known of it)", i), "trace with more rays");
  if (!problems.empty()) throw InputError(problems);
}

DistanceSamples pair_samples(const Enclosure& enclosure, const HitCounts& counts, double cutoff) {
  const std::size_t n = enclosure.sphere_count();
  const double diameter_m =
      2 * std::accumulate(enclosure.radius_m.begin(), enclosure.radius_m.end(), 0.0) / static_cast<double>(n);
  const CellGrid grid(enclosure.centre_m, cutoff * diameter_m, enclosure.box);
  std::vector<DistanceSamples> rows(n);
#pragma omp parallel for schedule(dynamic, 32)
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 centre = enclosure.centre_m[i];
    for (const std::int32_t j : grid.around(centre)) {
      const double d_star = norm(enclosure.centre_m[j] - centre) / diameter_m;
      if (static_cast<std::size_t>(j) > i && d_star < cutoff)
        add_sample(counts, i, static_cast<std::size_t>(j), d_star, unobstructed_pair(d_star), rows[i]);
    }
  }
  DistanceSamples samples;
  for (const auto& row : rows) samples.append(row);
  return samples;
}

DistanceSamples wall_samples(const Enclosure& enclosure, const HitCounts& counts, std::size_t w) {
  DistanceSamples samples;
  const Wall& wall = enclosure.walls[w];
  const auto plane = plane_of(wall);
  if (!plane) return samples;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
    add_sample(counts, i, enclosure.sphere_count() + w,
               plane->height(enclosure.centre_m[i]) / (2 * enclosure.radius_m[i]),
               exact_sphere_wall(enclosure.centre_m[i], wall), samples);
  return samples;
}

}  // namespace

void DistanceSamples::append(const DistanceSamples& more) {
  distance.insert(distance.end(), more.distance.begin(), more.distance.end());
  factor.insert(factor.end(), more.factor.begin(), more.factor.end());
  variance.insert(variance.end(), more.variance.begin(), more.variance.end());
  unobstructed.insert(unobstructed.end(), more.unobstructed.begin(), more.unobstructed.end());
}

SampleSet make_samples(const Enclosure& enclosure, const HitCounts& counts, double pp_cutoff,
                       const std::string& origin) {
  refuse_unfit(enclosure, counts, origin);
  SampleSet set;
  set.origin = origin;
  set.solid_fraction = solid_fraction(enclosure);
  set.enclosure = enclosure;
  set.pairs = pair_samples(enclosure, counts, pp_cutoff);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    set.walls.push_back(wall_samples(enclosure, counts, w));
  return set;
}

}  // namespace granrad
