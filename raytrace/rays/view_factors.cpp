#include "raytrace/rays/view_factors.h"

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/rays/error_target.h"

namespace granrad {

HitCounts trace_view_factors(const Enclosure& enclosure, const TraceOptions& options, TraceReport* report) {
  const EmbreeTracer tracer(enclosure, options.threads);
  const auto follow = [&](const EmittedRay& ray) {
    const End end = tracer.first_end(ray.start.origin_m, ray.start.direction, ray.surface, ray.start.normal);
    return RayEnd{end.surface, end.distance_m};
  };
  return trace_to_target(enclosure, surface_areas(enclosure), options, follow, report);
}

}  // namespace granrad
