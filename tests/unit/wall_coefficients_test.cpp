// Requirement: h_wp, Nu and Peclet numbers are those of the paper's equations.
#include "coupling/heat/wall_coefficients.h"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/heat/wall_area.h"

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
  const auto c = wall_coefficients(channel(), channel().box, {10, 20, 40}, 500);
  ASSERT_TRUE(c);
  const double scale = 1 / (500 * 2 * 0.010 * 0.050);
  EXPECT_NEAR(c->h_W_m2K.solid, 10 * scale, 1e-10);
  EXPECT_NEAR(c->h_W_m2K.gas, 20 * scale, 1e-10);
  EXPECT_NEAR(c->h_W_m2K.radiation, 40 * scale, 1e-10);
  EXPECT_NEAR(c->per_watt, scale, 1e-12);
}

TEST(WallCoefficients, DoNotExistWithoutADifferenceOrAHotWall) {
  EXPECT_FALSE(wall_coefficients(channel(), channel().box, {1, 1, 1}, 1000));
  Bed bed = channel();
  for (auto& wall : bed.walls) wall.role = WallRole::adiabatic;
  EXPECT_FALSE(wall_coefficients(bed, bed.box, {1, 1, 1}, 500));
}

// Catches a mean wall temperature as driving difference (to plant: area-weighted, h of a hot and a cold wall).
TEST(WallCoefficients, DoNotExistForWallsOfSeveralTemperatures) {
  Bed bed = channel();
  bed.walls[3].temperature_K = 300;
  EXPECT_FALSE(wall_coefficients(bed, bed.box, {1, 1, 1}, 500));
  // Unless only one of them is in the region.
  const Box lower{{0, 0, 0}, {0.010, 0.003, 0.050}};
  EXPECT_TRUE(wall_coefficients(bed, lower, {1, 1, 1}, 500));
}

TEST(WallCoefficients, CountTheAreaInsideTheRegion) {
  const Box half{{0, 0, 0}, {0.010, 0.004, 0.025}};
  const auto c = wall_coefficients(channel(), half, {1, 0, 0}, 500);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->per_watt * 500 * 2 * 0.010 * 0.025, 1, 1e-7);
  Bed bed = channel();
  Wall far = bed.walls[2];
  for (auto& vertex : far.vertices) vertex.z += 1;
  bed.walls.push_back(far);
  EXPECT_NEAR(wall_coefficients(bed, bed.box, {1, 0, 0}, 500)->per_watt, 1 / (500 * 2 * 0.010 * 0.050),
              1e-10);
}

// A square of side 2 turned by 45 degrees reaches sqrt 2 from its middle: a box of half side 1 cuts its four corners,
// each a right triangle of height sqrt 2 - 1.
TEST(WallArea, IsThatOfThePartInTheBox) {
  const double r = std::sqrt(2.0), corner = (r - 1) * (r - 1);
  Wall square;
  square.vertices = {{r, 0, 0}, {0, r, 0}, {-r, 0, 0}, {0, -r, 0}};
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_NEAR(area_inside(square, box), 4 - 4 * corner, 1e-7);
  Wall mesh = square;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NEAR(area_inside(mesh, box), 4 - 4 * corner, 1e-7);
  EXPECT_EQ(area_inside(square, {{-1, -1, 0.5}, {1, 1, 1}}), 0);
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
