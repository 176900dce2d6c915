#include "raytrace/rays/patch_rays.h"

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
  return {spheres + patches_->at(end.surface - spheres, origin + end.distance_m * direction), end.distance_m};
}

}  // namespace granrad
