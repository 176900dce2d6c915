#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/slab/slab.h"

namespace granrad {

struct ExtinctionRequest {
  std::int64_t rays = 1000000;
  std::uint64_t seed = 1;
  int threads = 0;
};

/// How far radiation goes in the void of a bed before it meets a sphere.
struct Extinction {
  Estimate coefficient_per_m;  ///< beta
  Estimate mean_free_path_m;   ///< 1 / beta
  Estimate mean_free_path_d;   ///< in mean diameters
  Estimate scattering_cosine;  ///< mean cosine of the angle between incoming and diffusely reflected light
  std::vector<double> distance_m, transmittance,
      transmittance_error;  ///< part that goes further (product limit
                            ///< over intervals, walls censor)
  double solid_fraction_void =
      0;  ///< part of the starts that fell into spheres: the solid fraction, overlaps once
  std::int64_t rays = 0;
};

/// Rays from points uniform in the void (of the box of the spheres' centres where nothing is periodic) in every
/// direction, followed to the first sphere. A wall ends a ray unseen (a censored length), so beta = hits / total
/// length, the maximum likelihood estimate for exponential extinction; the product limit is Kaplan and Meier's (J. Am.
/// Stat. Assoc. 53 (1958) 457); its error is the scatter of 16 batches.
/// For opaque spheres placed at random, overlapping, extinction is exponential with beta = n pi r^2 exactly, and the
/// cosine of diffuse reflection is -4/9 for every convex shape. Throws InputError (no spheres, no void).
Extinction measure_extinction(const Enclosure& enclosure, const ExtinctionRequest& request);

}  // namespace granrad
