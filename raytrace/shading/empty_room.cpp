#include "raytrace/shading/empty_room.h"

#include <omp.h>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/exact.h"
#include "raytrace/rays/emission.h"
#include "raytrace/rays/sampling.h"

namespace granrad {

EmptyRoom::EmptyRoom(const Enclosure& enclosure, int threads)
    : walls_(enclosure), facets_(1e-9 * norm(enclosure.box.size())) {
  walls_.centre_m.clear();
  walls_.radius_m.clear();
  walls_.particle.clear();
  bool planar = true;
  for (std::size_t w = 0; w < walls_.walls.size(); ++w) {
    planar = planar && plane_of(walls_.walls[w]).has_value();
    facets_.add(walls_.walls[w], static_cast<std::int32_t>(w), {}, 1);
  }
  if (planar) cell_ = ConvexCell::from(facets_);
  if (!convex()) tracer_.emplace(walls_, threads);
}

EmptyRoom::End EmptyRoom::end(const Vec3& origin, const Vec3& direction) const {
  if (cell_) {
    const FacetHit hit = cell_->exit(facets_, origin, direction);
    return {hit.facet < 0 ? -1 : facets_.wall(hit.facet), hit.distance};
  }
  if (!tracer_) return {-1, infinity};
  const auto met = tracer_->first_end(origin, direction, -1);
  const auto walls = static_cast<std::int32_t>(walls_.walls.size());
  return {met.surface >= 0 && met.surface < walls ? met.surface : -1, met.distance_m};
}

EmptyRoom::Factors EmptyRoom::factors(const Enclosure& enclosure, std::uint64_t seed, int threads) const {
  if (!convex()) return traced_factors(enclosure, seed, threads);
  Factors found;
  for (const Vec3& centre : enclosure.centre_m)
    for (const Wall& wall : walls_.walls) found.value.push_back(exact_sphere_wall(centre, wall));
  found.variance.assign(found.value.size(), 0);
  return found;
}

EmptyRoom::Factors EmptyRoom::traced_factors(const Enclosure& enclosure, std::uint64_t seed,
                                             int threads) const {
  constexpr int replicates = 4, rays = 512;
  const Emitter emitter(enclosure);
  const std::size_t n = enclosure.sphere_count();
  Factors found;
  found.value.assign(n * walls(), 0);
  std::vector<double> spread(n, 0);
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> hits(replicates * walls(), 0);
    for (int r = 0; r < replicates; ++r) {
      const RaySampler sampler(Sampling::sobol, seed, static_cast<std::int32_t>(i), r);
      for (std::uint64_t ray = 0; ray < rays; ++ray) {
        const auto u = sampler(ray);
        const Emission start = emitter.emit(static_cast<std::int32_t>(i), u[0], u[1], u[2], u[3]);
        const std::int32_t wall = end(start.origin_m, start.direction).wall;
        if (wall >= 0) hits[static_cast<std::size_t>(r) * walls() + static_cast<std::size_t>(wall)] += 1;
      }
    }
    for (std::size_t w = 0; w < walls(); ++w) {
      double mean = 0, squares = 0;
      for (int r = 0; r < replicates; ++r) mean += hits[r * walls() + w] / replicates;
      for (int r = 0; r < replicates; ++r)
        squares += (hits[r * walls() + w] - mean) * (hits[r * walls() + w] - mean);
      found.value[i * walls() + w] = mean / rays;
      spread[i] += squares / (replicates - 1);  // of one count
    }
  }
  double spread_in_all = 0, binomial_in_all = 0;
  for (const double s : spread) spread_in_all += s;
  for (const double f : found.value) binomial_in_all += rays * f * (1 - f);
  const double ratio = binomial_in_all > 0 ? spread_in_all / binomial_in_all : 0;
  for (const double f : found.value) found.variance.push_back(ratio * f * (1 - f) / (rays * replicates));
  return found;
}

}  // namespace granrad
