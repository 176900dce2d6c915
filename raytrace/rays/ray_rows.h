#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "raytrace/rays/emission.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {

/// One ray that has left its surface: what names it, and its start.
struct EmittedRay {
  std::int32_t surface, replicate;
  std::uint64_t ray;
  Emission start;
};

/// Where it ended.
struct RayEnd {
  std::int32_t surface;  ///< -1: leaked
  double chord_m;        ///< free length of its first flight; infinite when it met nothing
};

constexpr std::int64_t most_rays_of_a_surface = std::int64_t{1}
                                                << 31;  ///< what tallies and samplers count to

/// Sends `rays` from every surface, in replicates of equal size, and counts where `follow` says they end.
/// Surfaces, or fixed parts of those with many rays, are shared out to threads and gathered in order, so the
/// counts do not depend on the number of threads. `follow` is called from several threads. Fills everything
/// of HitCounts. Throws TraceStopped when options.watch says so, InputError for more than
/// most_rays_of_a_surface.
HitCounts trace_rows(const Enclosure& enclosure, const std::vector<double>& emitting_area_m2,
                     const std::vector<std::int64_t>& rays, const TraceOptions& options,
                     const std::function<RayEnd(const EmittedRay&)>& follow);

}  // namespace granrad
