// Requirement: h_wp, Nu and Peclet numbers are those of the paper's equations.
#include "coupling/heat/wall_coefficients.h"

#include <gtest/gtest.h>

namespace granrad {
namespace {

Bed channel() {
  Bed bed;
  bed.box = {{0, 0, 0}, {0.010, 0.004, 0.050}};
  for (auto wall : box_walls(bed.box)) bed.walls.push_back(wall);
  for (int w : {2, 3}) {
    bed.walls[w].role = WallRole::isothermal;
    bed.walls[w].temperature_K = 1000;
  }
  return bed;
}

TEST(WallCoefficients, AreHeatOverAreaAndTemperatureDifference) {
  const auto c = wall_coefficients(channel(), {10, 20, 40}, 500, 8e-4, 0.026);
  ASSERT_TRUE(c);
  const double scale = 1 / (500 * 2 * 0.010 * 0.050);
  EXPECT_NEAR(c->h_W_m2K.solid, 10 * scale, 1e-10);
  EXPECT_NEAR(c->h_W_m2K.gas, 20 * scale, 1e-10);
  EXPECT_NEAR(c->h_W_m2K.radiation, 40 * scale, 1e-10);
  EXPECT_NEAR(c->h_wp_W_m2K, 70 * scale, 1e-10);
  EXPECT_NEAR(c->Nu_d, 70 * scale * 8e-4 / 0.026, 1e-12);
}

TEST(WallCoefficients, DoNotExistWithoutADifferenceOrAHotWall) {
  EXPECT_FALSE(wall_coefficients(channel(), {1, 1, 1}, 1000, 8e-4, 0.026));
  Bed bed = channel();
  for (auto& wall : bed.walls) wall.role = WallRole::adiabatic;
  EXPECT_FALSE(wall_coefficients(bed, {1, 1, 1}, 500, 8e-4, 0.026));
}

TEST(Peclet, NumbersOfThePaper) {
  Material alumina;
  alumina.density_kg_m3 = 3984;
  alumina.specific_heat_J_kgK = 755;
  alumina.conductivity_W_mK = 33;
  const double L = 0.05;
  for (const auto& [velocity, printed] : {std::pair{0.1425, 660.0}, {0.0399, 189.0}, {0.0232, 109.0}})
    EXPECT_NEAR(peclet_length(velocity, L, alumina) / printed, 1, 0.04);
  EXPECT_NEAR(peclet_modified(176, L, 8e-4, alumina, 0.026) / 72000, 1, 0.02);
}

}  // namespace
}  // namespace granrad
