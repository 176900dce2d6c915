#pragma once
#include "raytrace/rays/ray_rows.h"

namespace granrad {

/// trace_rows with options.rays_per_particle, or in rounds, each with the rays that the last one calls for
/// but at most four times as many, until the stated error is below options.target_error. Every round traces
/// the same points as the one before and more, so the last one is kept whole. Throws ThresholdMissed when a
/// surface would need more than most_rays_of_a_surface, and what trace_rows throws.
HitCounts trace_to_target(const Enclosure& enclosure, const std::vector<double>& emitting_area_m2,
                          const TraceOptions& options, const std::function<RayEnd(const EmittedRay&)>& follow,
                          TraceReport* report);

}  // namespace granrad
