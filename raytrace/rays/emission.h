#pragma once
#include <cstdint>

#include "dem/bed/wall_shape.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// A point on a surface, a direction into the void, and the unit normal there.
struct Emission {
  Vec3 origin_m, direction, normal;
};

/// Cosine-distributed direction about `normal` from two uniforms in [0, 1): sin^2(theta) = u (Modest, Radiative Heat
/// Transfer, chapter on Monte Carlo methods).
Vec3 cosine_direction(const Vec3& normal, double u, double v);

/// Diffuse emission from every point of a surface alike: four uniforms -> point uniform in area (sphere,
/// wall, on the normal side of its faces) and cosine direction. Precondition: not the open surface.
class Emitter {
 public:
  explicit Emitter(const Enclosure& enclosure);  ///< keeps a reference
  Emission emit(std::int32_t surface, double u0, double u1, double u2, double u3) const;

 private:
  const Enclosure& enclosure_;
  struct Source {  ///< a wall as it is sampled
    Parallelogram figure;
    Vec3 normal;  ///< of the figure
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<double> cumulative_area_m2;  ///< over the triangles; empty: the wall is the figure
  };
  std::vector<Source> sources_;
};

}  // namespace granrad
