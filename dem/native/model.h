#pragma once
#include <array>

#include "dem/bed/bed.h"
#include "dem/native/kernels.h"
#include "dem/native/rows.h"
#include "dem/scene/scene.h"

namespace granrad::native {

/// Faster than this fraction of its radius per step in any direction, a particle tunnels: it would meet
/// others deeper than the contact model holds.
inline constexpr double fastest_step = 0.1;

/// Everything the inner loops need beside the rows; fixed while particles and materials stay the same.
struct Model {
  StepConstants constants{};
  MoveConstants move{};
  alignas(64) std::array<double, 8> kick_row{};
  double largest_radius = 0;
  double largest_force_units = 0;  ///< no component of a contact force may exceed it
};

/// Forces are summed as integers, so that no order matters. Each radius has its own unit (a power of two): the
/// sum of as many contacts as fit around a sphere, each at the deepest overlap and the highest speed that a
/// sphere of its size may have, stays below 2^62. In mixed precision a single force stays below 2^51 units,
/// which keeps all 24 bits of a force of 1e-6 of the largest. A force beyond that is found in the step that
/// makes it (`largest_force_units`); a weight too small for its unit is refused here (InputError).
/// Also fills rows.scales and, where particles differ, rows.kick.
Model make_model(const Bed& bed, Rows& rows, const Periods& periods, const Vec3& gravity_m_s2, double step_s,
                 Precision precision = Precision::full, bool records_touches = false);

}  // namespace granrad::native
