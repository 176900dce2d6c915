#pragma once
#include <cstdint>

#include "raytrace/enclosure.h"

namespace granrad {

/// A point on a surface and a direction into the void.
struct Emission {
  Vec3 origin_m, direction;
};

/// Cosine-distributed direction about `normal` from two uniforms in [0, 1): sin^2(theta) = u.
Vec3 cosine_direction(const Vec3& normal, double u, double v);

/// Diffuse emission from every point of a surface alike: four uniforms -> point uniform in area (sphere,
/// convex polygon or mesh, on its normal side) and cosine direction. Precondition: not the open surface.
class Emitter {
 public:
  explicit Emitter(const Enclosure& enclosure);  ///< keeps a reference
  Emission emit(std::int32_t surface, double u0, double u1, double u2, double u3) const;

 private:
  const Enclosure& enclosure_;
  std::vector<std::vector<double>> cumulative_area_;  ///< per wall, over its triangles (a fan for polygons)
};

}  // namespace granrad
