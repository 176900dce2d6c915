#include "raytrace/view_factors.h"

#include <algorithm>
#include <cmath>

#include "raytrace/embree_tracer.h"
#include "raytrace/ray_rows.h"

namespace granrad {

namespace {

/// p_i: fraction of particle i's rays that end on walls and surroundings; and the variance of that estimate.
struct WallSum {
  double value, variance;
};

WallSum wall_sum(const Enclosure& enclosure, const HitCounts& counts, std::size_t i) {
  const auto walls = static_cast<std::int32_t>(enclosure.sphere_count());
  const double n = static_cast<double>(counts.launched[i]);
  double hits = 0;
  for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
    if (counts.pattern.column[static_cast<std::size_t>(k)] >= walls)
      hits += static_cast<double>(counts.hits[static_cast<std::size_t>(k)]);
  const double p = (hits + 0.5) / (n + 1);
  return {hits / n, p * (1 - p) / n * counts.wall_sum_variance_factor};
}

HitCounts trace(const Enclosure& enclosure, const EmbreeTracer& tracer, const std::vector<std::int64_t>& rays,
                const TraceOptions& options) {
  return trace_rows(enclosure, surface_areas(enclosure), rays, options, [&](const EmittedRay& ray) {
    const Hit hit = tracer.first_hit(ray.start.origin_m, ray.start.direction, ray.surface);
    return RayEnd{hit.surface, hit.distance_m};
  });
}

/// Rays that bring the rms error of the wall sums down to `error` of their mean, at the least number of rays
/// in all: sum_i f_i p_i (1 - p_i) / n_i is least at fixed sum of n_i for n_i ~ sqrt(f_i p_i (1 - p_i)).
std::vector<std::int64_t> rays_for(const Enclosure& enclosure, const HitCounts& known, double error) {
  const std::size_t spheres = enclosure.sphere_count();
  std::vector<double> spread(spheres);
  double spread_sum = 0, mean = 0;
  for (std::size_t i = 0; i < spheres; ++i) {
    const WallSum sum = wall_sum(enclosure, known, i);
    spread[i] = std::sqrt(sum.variance * static_cast<double>(known.launched[i]));
    spread_sum += spread[i];
    mean += sum.value / static_cast<double>(spheres);
  }
  const double variance_sum = static_cast<double>(spheres) * error * error * mean * mean;
  std::vector<std::int64_t> rays(enclosure.surface_count(), 0);
  double total = 0, area = 0;
  const auto area_m2 = surface_areas(enclosure);
  for (std::size_t i = 0; i < spheres; ++i) {
    rays[i] = std::max<std::int64_t>(64, std::llround(std::min(1e9, spread[i] * spread_sum / variance_sum)));
    total += static_cast<double>(rays[i]);
    area += area_m2[i];
  }
  for (std::size_t w = spheres; w + 1 < rays.size(); ++w)
    rays[w] = std::max<std::int64_t>(64, std::llround(total * area_m2[w] / area));
  return rays;
}

}  // namespace

double wall_sum_error(const Enclosure& enclosure, const HitCounts& counts) {
  double variance = 0, value = 0;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const WallSum sum = wall_sum(enclosure, counts, i);
    variance += sum.variance;
    value += sum.value;
  }
  if (!(value > 0)) return 0;
  return std::sqrt(variance * static_cast<double>(enclosure.sphere_count())) / value;
}

HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options) {
  const EmbreeTracer tracer(enclosure, options.threads);
  const auto area = surface_areas(enclosure);
  if (options.target_error <= 0 || enclosure.sphere_count() == 0)
    return trace(enclosure, tracer, rays_per_surface(enclosure, area, options.rays_per_particle), options);

  constexpr double pilot_rays = 256, aim = 0.95;
  constexpr int most_rounds = 6;
  HitCounts counts = trace(enclosure, tracer, rays_per_surface(enclosure, area, pilot_rays), options);
  for (int round = 0; round < most_rounds; ++round) {
    const double error = wall_sum_error(enclosure, counts);
    if (error <= options.target_error) break;
    counts = trace(enclosure, tracer, rays_for(enclosure, counts, aim * options.target_error), options);
  }
  return counts;
}

}  // namespace granrad
