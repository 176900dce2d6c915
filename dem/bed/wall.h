#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/base/toml/choice_names.h"
#include "dem/base/vec3.h"
#include "dem/bed/box.h"

namespace granrad {

/// What a wall does for radiation. A scene must choose (design: walls have roles).
enum class WallRole {
  isothermal,  ///< fixed temperature, emissivity in [0, 1]
  adiabatic,   ///< re-radiates what it receives; no net heat
  open,        ///< exchanges as a black surface at `temperature_K` (the surroundings)
  excluded,    ///< blocks rays, but is dropped before closure (the paper's four unheated walls)
};

inline constexpr ChoiceNames<WallRole::excluded> wall_roles;
inline const char* to_string(WallRole role) {
  return wall_roles.of(role);
}

/// A temperature given over time: linear between the instants, constant before the first and after the last.
struct TemperatureCourse {
  std::vector<double> time_s, temperature_K;  ///< of equal length; times ascend; none: no course

  bool empty() const { return time_s.empty(); }
  double at(double t_s) const;
  /// Exact; the temperature itself where both instants are one. Preconditions: not empty, from_s <= to_s.
  double mean(double from_s, double to_s) const;
};

/// A wall: where it is, its thermal condition and its contact. Its shape is a set of convex planar faces; the
/// right-hand normal of a face points to the side where the particles are, and that side radiates. Contact
/// works from both sides. What can be asked of the shape is in wall_shape.h: nothing else looks into it.
struct Wall {
  std::string name{};
  std::vector<Vec3> vertices{};  ///< of one convex polygon, or those `triangles` index
  std::vector<std::array<std::int32_t, 3>> triangles{};  ///< none: the vertices are one polygon
  WallRole role = WallRole::adiabatic;
  double temperature_K = 300;
  TemperatureCourse course{};  ///< what makes temperature_K change (hold_temperatures)
  double emissivity = 1;
  bool contact = true;  ///< particles touch it; false: a radiating boundary only (the ends of a channel)
  Vec3 velocity_m_s{};  ///< of the sliding surface (a belt), along it; the geometry does not move
  double opens_at_s = infinity;  ///< a shutter: gone from then on
};

/// Whether the wall has a temperature of its own that it gives to what touches it.
inline bool conducts(const Wall& wall) {
  return wall.role == WallRole::isothermal;
}
/// Whether it is there at `time_s`: not a shutter that has opened.
inline bool exists(const Wall& wall, double time_s) {
  return time_s < wall.opens_at_s;
}
/// Whether particles touch it at `time_s`.
inline bool stands(const Wall& wall, double time_s) {
  return wall.contact && exists(wall, time_s);
}

/// Sets the walls that `given` has a course for to their mean temperature from `from_s` to `to_s`. `given`: the same walls
/// as the scene gives them; frames keep temperatures and no courses.
void hold_temperatures(std::vector<Wall>& walls, const std::vector<Wall>& given, double from_s, double to_s);
/// The highest temperature the wall ever has.
double hottest_K(const Wall& wall);

/// The next time after `time_s` at which a shutter that particles touch opens, or infinity.
double next_opening_s(const std::vector<Wall>& walls, double time_s);

/// The six polygons x_min, x_max, y_min, y_max, z_min, z_max of a box, in this order, normals inward.
std::array<Wall, 6> box_walls(const Box& box);

}  // namespace granrad
