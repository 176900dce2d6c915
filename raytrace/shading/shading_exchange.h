#pragma once
#include <cstdint>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

class WallPatches;

struct ShadingOptions {
  double rays_per_particle = 200;  ///< that the walls send, in all and in proportion to their areas
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default; results do not depend on it
  const WallPatches* patches =
      nullptr;  ///< of the walls; surfaces are then those of patches->applied_to(enclosure)
};

/// Throws InputError: radii that differ, periodic boxes, walls so wide beside the spheres that fewer than 10 of their rays
/// are due to each sphere.
void refuse_what_shading_cannot_serve(const Enclosure& enclosure, double rays_per_particle);

/// Exchange areas X_ij = A_i F_ij of equal spheres (radii within 1 %) and their walls by explicit shading, of walls by
/// rays; nothing is fitted. Not yet closed.
///  - sphere-sphere, as far as shade_spheres follows them (beyond is 0.05 % of F, which closure gives back): the exact
///    factor of the two times the share of 1024 to 64 lines between them that no sphere, and no wall of an enclosure that
///    is not convex, blocks. rms error of F in random beds 2e-5 to 7e-5 (solid fractions 0.07 to 0.43).
///  - sphere-wall: every line from a sphere that ends on another would have met some wall of the empty room. So
///      F_iw = F_iw of the empty room - sum over the spheres j that i sees of F_ij (share of its free lines aimed at w),
///    merged by likelihood with the walls' rays (Embree); these alone tell on which patches it lies.
///  - wall-wall: the walls' rays.
///  - surroundings: by the walls' rays; of a sphere what is missing to its area, where anything is open.
/// Symmetric. Variances: of walls by their counts, of a pair of spheres binomial (its lines are even).
/// Throws InputError as refuse_what_shading_cannot_serve.
ExchangeAreas shading_exchange_areas(const Enclosure& enclosure, const ShadingOptions& options);

}  // namespace granrad
