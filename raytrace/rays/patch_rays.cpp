#include "raytrace/rays/patch_rays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace granrad {

PatchRays::PatchRays(const Enclosure& enclosure, const WallPatches* patches, int threads)
    : whole_(enclosure), patches_(patches), tracer_(enclosure, threads) {
  if (patches) cut_ = patches->applied_to(enclosure);
}

RayEnd PatchRays::follow(const EmittedRay& ray) const {
  const auto spheres = static_cast<std::int32_t>(whole_.sphere_count());
  const auto open = static_cast<std::int32_t>(whole_.open_surface());
  const Vec3 &origin = ray.start.origin_m, &direction = ray.start.direction;
  const std::int32_t from =
      patches_ && ray.surface >= spheres ? spheres + patches_->wall(ray.surface - spheres) : ray.surface;
  const End end = tracer_.first_end(origin, direction, from, ray.start.normal);
  if (!patches_ || end.surface < spheres) return {end.surface, end.distance_m};
  if (end.surface == open) return {spheres + patches_->count(), end.distance_m};
  return {spheres + patches_->at(end.surface - spheres, origin + end.distance_m * direction, origin),
          end.distance_m};
}

HitCounts PatchRays::trace_walls(double rays, std::uint64_t seed, int threads) const {
  constexpr double least_of_wall = 1000, least_of_patch = 64;
  const auto area = surface_areas(surfaces());
  const std::size_t spheres = whole_.sphere_count(), open = surfaces().open_surface();
  const double walls_m2 =
      std::accumulate(area.begin() + static_cast<std::ptrdiff_t>(spheres), area.end(), 0.0);
  std::vector<std::int64_t> sent(surfaces().surface_count(), 0);
  for (std::size_t s = spheres; s < open; ++s) {
    const auto patch = static_cast<std::int32_t>(s - spheres);
    const bool cut = patches_ && patches_->is_cut(patches_->wall(patch));
    sent[s] = std::llround(std::max(cut ? least_of_patch : least_of_wall, rays * area[s] / walls_m2));
  }
  TraceOptions options;
  options.seed = seed;
  options.threads = threads;
  return trace_rows(surfaces(), area, sent, options, [&](const EmittedRay& ray) { return follow(ray); });
}

}  // namespace granrad
