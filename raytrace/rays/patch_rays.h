#pragma once
#include <optional>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/rays/ray_rows.h"
#include "raytrace/wall_patches.h"

namespace granrad {

/// Rays that surfaces, walls cut into patches among them, send through an enclosure of whole walls: the tracer knows
/// nothing of patches and is as fast as without. Keeps references.
class PatchRays {
 public:
  /// `patches`: of the enclosure's walls, or null.
  PatchRays(const Enclosure& enclosure, const WallPatches* patches, int threads);

  /// The enclosure with a wall for each patch.
  const Enclosure& surfaces() const { return cut_ ? *cut_ : whole_; }
  /// Where a ray of one of those surfaces ends.
  RayEnd follow(const EmittedRay& ray) const;
  /// Rows of the walls alone: `rays` in all, in proportion to area, at least 1000 of a whole wall and 64 of a patch.
  HitCounts trace_walls(double rays, std::uint64_t seed, int threads) const;

 private:
  const Enclosure& whole_;
  const WallPatches* patches_;
  std::optional<Enclosure> cut_;
  EmbreeTracer tracer_;
};

}  // namespace granrad
