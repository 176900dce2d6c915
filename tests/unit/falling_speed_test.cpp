// Requirement: the impact speed that limits the step is that of a fall along gravity, whichever way it points: a scene
// turned with its gravity has the step it had.
// Planted, seen to fail: the extent along z for every direction of gravity.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation/step_limits.h"

namespace granrad {
namespace {

double impact_speed_m_s(const Vec3& size_m, const Vec3& gravity_m_s2) {
  Case c;
  c.flow.materials = {Material{}};
  c.flow.materials[0].density_kg_m3 = 2500;
  c.flow.materials[0].specific_heat_J_kgK = 800;
  c.flow.materials[0].youngs_modulus_Pa = 5e6;
  c.flow.particle_diameter_m = 1e-3;
  c.flow.box = {{0, 0, 0}, size_m};
  c.flow.gravity_m_s2 = gravity_m_s2;
  Bed bed;
  bed.materials = c.flow.materials;
  bed.box = c.flow.box;
  return step_limits(c, bed).impact_speed_m_s;
}

TEST(FallingSpeed, TurnsWithTheScene) {
  EXPECT_NEAR(impact_speed_m_s({0.01, 0.02, 0.3}, {0, 0, -9.81}), 1e-3 + std::sqrt(2 * 9.81 * 0.3), 2e-3);
  const double upright = impact_speed_m_s({0.01, 0.02, 0.3}, {0, 0, -9.81});
  EXPECT_EQ(impact_speed_m_s({0.01, 0.3, 0.02}, {0, 9.81, 0}), upright);
  EXPECT_EQ(impact_speed_m_s({0.3, 0.02, 0.01}, {-9.81, 0, 0}), upright);
}

}  // namespace
}  // namespace granrad
