#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// The surfaces that exchange radiation, as every tracer sees them. Surface numbers, used by all results:
/// 0 .. N-1 the spheres, N .. N+W-1 the walls, N+W the surroundings ("open": whatever leaves through no
/// wall).
struct Enclosure {
  std::vector<Vec3> centre_m;
  std::vector<double> radius_m;
  std::vector<std::int32_t> particle;  ///< index in the Bed of each sphere
  std::vector<Wall> walls;             ///< convex polygons and meshes; their normal side radiates
  std::array<bool, 3> periodic{};
  Box box;                           ///< periods, where periodic
  std::vector<std::int32_t> wall{};  ///< index in Bed::walls of each wall
  std::vector<std::int32_t>
      material{};  ///< index in Bed::materials of each sphere, of an enclosure made of a Bed
  /// Solid fraction of the region the enclosure was made for (dem/bed/solid_fraction.h), spheres across its
  /// faces counted with the part inside; 0: not known (no region, or one that is larger than the walls).
  double solid_fraction = 0;

  std::size_t sphere_count() const { return centre_m.size(); }
  std::size_t open_surface() const { return centre_m.size() + walls.size(); }
  std::size_t surface_count() const { return open_surface() + 1; }
};

/// Area of every surface, m^2; 0 for the surroundings. Overlapping spheres keep their full area (design:
/// a ray that starts inside a neighbour is a hit on it at distance zero).
std::vector<double> surface_areas(const Enclosure& enclosure);

/// Particles of `bed` whose centre lies in `region` (in the periodic image inside the box), and the walls of
/// the bed that have a part in the region or on its boundary, with all sides of a body of plates; shutters that are open at bed.time_s are gone.
/// A polygon wall without contact (the end of a channel) is moved outwards along its normal until it clears
/// every sphere of the enclosure, and the polygons that border it are stretched along with it, so that a box
/// stays closed. Throws InputError when a sphere centre lies behind a contact polygon on a face of the box,
/// NumericalError when a position is not finite.
Enclosure make_enclosure(const Bed& bed, const Box& region);

}  // namespace granrad
