#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/stated_error.h"

namespace granrad {

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
