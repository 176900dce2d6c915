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

/// Rays each surface sends for options.rays_per_particle; walls at the mean density of the particles (without
/// particles: at the mean density of the walls) as far as spare_wide_walls lets them. Zero where `emitting_area_m2` is zero.
std::vector<std::int64_t> rays_per_surface(const Enclosure& enclosure,
                                           const std::vector<double>& emitting_area_m2,
                                           double rays_per_particle);

/// Caps what the walls of a wide enclosure send: in all no more than its particles, or than 600 particles (but 6e6
/// rays, or 6 particles); each wall at least as many as a particle. A pair is merged by rays per area (exchange.h), so that a small sphere far from its
/// walls is known by its own rays and the walls' row follows by reciprocity. Nothing changes without particles.
void spare_wide_walls(std::vector<std::int64_t>& rays, std::size_t spheres, double rays_per_particle);

/// Sends `rays` from every surface, in replicates of equal size, and counts where `follow` says they end.
/// Surfaces, or fixed parts of those with many rays, are shared out to threads and gathered in order, so the
/// counts do not depend on the number of threads. `follow` is called from several threads. Fills everything
/// of HitCounts. Throws TraceStopped when options.watch says so, InputError for more than
/// most_rays_of_a_surface.
HitCounts trace_rows(const Enclosure& enclosure, const std::vector<double>& emitting_area_m2,
                     const std::vector<std::int64_t>& rays, const TraceOptions& options,
                     const std::function<RayEnd(const EmittedRay&)>& follow);

}  // namespace granrad
