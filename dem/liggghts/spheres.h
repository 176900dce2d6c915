#pragma once
#include <cstdint>
#include <vector>

#include "dem/base/vec3.h"

namespace granrad::liggghts {

/// A tangential spring of a sphere, seen by it.
struct Spring {
  static constexpr std::int32_t pair = -1;

  std::int32_t sphere;   ///< index
  std::int32_t mesh;     ///< of walls, or `pair`
  std::int32_t partner;  ///< index of the other sphere, or of a triangle in its mesh (its id there)
  Vec3 displacement_m;
};

/// All that LIGGGHTS moves. Columns have equal length; an index means the same before and after a run.
struct Spheres {
  std::vector<Vec3> position_m, velocity_m_s, angular_velocity_rad_s;
  std::vector<double> radius_m, density_kg_m3;
  std::vector<std::int32_t> type;  ///< from 1
  /// By sphere in ascending order; of one sphere those at walls first, then pairs, each once (sphere < partner) and in
  /// ascending order of partners.
  std::vector<Spring> springs;
};

}  // namespace granrad::liggghts
