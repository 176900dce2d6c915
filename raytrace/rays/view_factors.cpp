#include "raytrace/rays/view_factors.h"

#include "raytrace/rays/error_target.h"
#include "raytrace/rays/patch_rays.h"

namespace granrad {

HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options, TraceReport* report,
                             const WallPatches* patches) {
  const PatchRays rays(enclosure, patches, options.threads);
  const auto follow = [&](const EmittedRay& ray) { return rays.follow(ray); };
  return trace_to_target(rays.surfaces(), surface_areas(rays.surfaces()), options, follow, report);
}

}  // namespace granrad
