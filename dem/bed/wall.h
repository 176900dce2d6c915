#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/base/vec3.h"
#include "dem/bed/box.h"

namespace granrad {

/// What a wall does for radiation. A scene must choose (design: walls have roles).
enum class WallRole {
  isothermal,  ///< fixed temperature, emissivity in (0, 1]
  adiabatic,   ///< re-radiates what it receives; no net heat
  open,        ///< exchanges as a black surface at `temperature_K` (the surroundings)
  excluded,    ///< blocks rays, but is dropped before closure (the paper's four unheated walls)
};

const char* to_string(WallRole role);

/// A wall: a planar convex polygon (no triangles), or a triangle mesh (triangles index `vertices`).
/// The right-hand normal of polygon and triangles points to the side where the particles are; that side
/// radiates. Contact works from both sides.
struct Wall {
  std::string name{};
  std::vector<Vec3> vertices{};
  std::vector<std::array<std::int32_t, 3>> triangles{};
  WallRole role = WallRole::adiabatic;
  double temperature_K = 300;
  double emissivity = 1;
  bool contact = true;  ///< particles touch it; false: a radiating boundary only (the ends of a channel)
  Vec3 velocity_m_s{};  ///< of the sliding surface (a belt), along it; the geometry does not move
  double opens_at_s = infinity;  ///< a shutter: no contact from then on

  bool is_polygon() const { return triangles.empty(); }
};

/// Area in m^2 of polygon or mesh.
double area(const Wall& wall);
/// Unit normal of a polygon wall (Newell's method). Precondition: is_polygon().
Vec3 polygon_normal(const Wall& wall);

/// The next time after `time_s` at which a shutter that particles touch opens, or infinity.
double next_opening_s(const std::vector<Wall>& walls, double time_s);

/// The six polygons x_min, x_max, y_min, y_max, z_min, z_max of a box, in this order, normals inward.
std::array<Wall, 6> box_walls(const Box& box);

}  // namespace granrad
