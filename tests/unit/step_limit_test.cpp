// Requirement: the step limits are the paper's formulas with the values physics gives them.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/step_limit.h"

namespace granrad {
namespace {

Material alumina() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23, m.restitution = 0.45,
  m.friction = 0.4;
  return m;
}

TEST(StepLimit, rayleigh_time_of_the_paper_belongs_to_the_larger_sphere) {
  EXPECT_NEAR(rayleigh_time_s(alumina(), 4e-4), 6.09e-5, 5e-8);
  EXPECT_NEAR(rayleigh_time_s(alumina(), 2e-4), 3.04e-5, 5e-8);
}

// With the effective values of two equal spheres written out: 2.87 (m^2 / (Y*^2 v d))^0.2.
TEST(StepLimit, hertz_time_falls_with_the_fifth_root_of_speed) {
  const double slow = hertz_time_s(alumina(), 4e-4, 0.01), fast = hertz_time_s(alumina(), 4e-4, 0.32);
  EXPECT_NEAR(slow / fast, 2, 1e-12);
  const double mass = 3984 * 4.0 / 3.0 * 3.14159265358979 * 6.4e-11, modulus = 5e6 / 2 / (1 - 0.23 * 0.23);
  EXPECT_NEAR(hertz_time_s(alumina(), 4e-4, 0.01) /
                  (2.87 * std::pow(mass * mass / (modulus * modulus * 0.01 * 8e-4), 0.2)),
              1, 1e-12);
}

}  // namespace
}  // namespace granrad
