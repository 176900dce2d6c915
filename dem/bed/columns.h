#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "dem/bed/bed.h"

namespace granrad {

/// What the numbers of a column must be, wherever they come from.
enum class ColumnKind {
  real,      ///< finite
  positive,  ///< finite and > 0
  whole,     ///< an integer >= 0
};

/// One column of the Bed as files name it. T: std::int64_t, std::int32_t, double or Vec3.
template <class T>
struct BedColumn {
  static constexpr int components = std::is_same_v<T, Vec3> ? 3 : 1;

  const char* name;                 ///< in /granrad/particles of a frame; ends with the unit
  const char* view;                 ///< point data of viewers: frames and vtp
  std::array<const char*, 3> text;  ///< columns of text files: one, or x y z of a vector
  const char* unit;
  ColumnKind kind;
  std::vector<T> Bed::*values;
  T initial;        ///< of a particle for which nobody gave one
  int since_frame;  ///< version of frames that hold it; older frames are read with `initial`
};

/// Every column of the Bed, in the order of text files. A new column is a member of Bed and a line here: adding,
/// removing and sorting particles, frames, imports and exports follow.
template <class Visit>
void for_each_column(Visit&& visit) {
  using enum ColumnKind;
  visit(BedColumn<std::int64_t>{"id", "id", {"id"}, "1", whole, &Bed::id, 0, 1});
  visit(BedColumn<std::int32_t>{"material", "material", {"material"}, "1", whole, &Bed::material, 0, 1});
  visit(BedColumn<Vec3>{"position_m", "position", {"x", "y", "z"}, "m", real, &Bed::position_m, {}, 1});
  visit(BedColumn<double>{"radius_m", "radius", {"radius"}, "m", positive, &Bed::radius_m, 0, 1});
  visit(BedColumn<Vec3>{"velocity_m_s", "v", {"vx", "vy", "vz"}, "m/s", real, &Bed::velocity_m_s, {}, 1});
  visit(BedColumn<Vec3>{"angular_velocity_rad_s",
                        "omega",
                        {"omegax", "omegay", "omegaz"},
                        "rad/s",
                        real,
                        &Bed::angular_velocity_rad_s,
                        {},
                        1});
  visit(BedColumn<double>{
      "temperature_K", "temperature", {"temperature"}, "K", positive, &Bed::temperature_K, 300, 1});
  visit(BedColumn<double>{"radiative_heat_W", "q_rad", {"q_rad"}, "W", real, &Bed::radiative_heat_W, 0, 1});
  visit(BedColumn<double>{"solid_heat_W", "q_ss", {"q_ss"}, "W", real, &Bed::solid_heat_W, 0, 3});
  visit(BedColumn<double>{"gas_heat_W", "q_sfs", {"q_sfs"}, "W", real, &Bed::gas_heat_W, 0, 3});
}

}  // namespace granrad
