#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/stated_error.h"

namespace granrad {

/// Rays each surface sends for options.rays_per_particle; walls at the mean density of the particles (without
/// particles: at the mean density of the walls) as far as spare_wide_walls lets them. Zero where `emitting_area_m2` is zero.
std::vector<std::int64_t> rays_per_surface(const Enclosure& enclosure,
                                           const std::vector<double>& emitting_area_m2,
                                           double rays_per_particle);

/// Caps what the walls of a wide enclosure send: in all no more than its particles, or than 600 particles (but 6e6
/// rays, or 6 particles); each wall at least as many as a particle. A pair is merged by rays per area (exchange.h), so that a small sphere far from its
/// walls is known by its own rays and the walls' row follows by reciprocity. Nothing changes without particles.
void spare_wide_walls(std::vector<std::int64_t>& rays, std::size_t spheres, double rays_per_particle);

/// Rays by surface that bring the stated error down to `error` with the fewest in all, judged by what `known`
/// counts found. A particle's sum is merged from its own rays and those of the counted walls, and divided by
/// its row sum, which its own rays know best; with densities (rays per area) q_i and q_w its variance is
///   A_i (u_i^2 / (q_i + q_w) + v_i^2 / q_i),
/// and sum_i A_i q_i + A_w q_w at a given sum of variances is least for
///   u_i^2 / (q_i + q_w)^2 + v_i^2 / q_i^2 = l,   sum_i A_i u_i^2 / (q_i + q_w)^2 = l A_w,
/// l from the error: the walls send what serves all particles, the particles add where that is not enough.
/// Walls that are not counted send at the mean density of the particles; every surface sends some.
std::vector<std::int64_t> rays_for_error(const HitCounts& known, const StatedQuantity& quantity,
                                         double error);

}  // namespace granrad
