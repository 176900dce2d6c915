// Requirement: a wall whose faces look both ways from one place has two sides, wherever it lies and however its two sides are cut
// into triangles; a closed body and a sheet of one side have not. Planted, seen to fail: triangles whose middles lie on
// edges of those behind them by rounding alone (12 of 40 000 places).
#include "raytrace/mesh_check.h"

#include <gtest/gtest.h>

#include <random>

#include "dem/bed/wall_shape.h"

namespace granrad {
namespace {

Wall plate_at(const Vec3& corner, double a, double b) {
  Wall wall;
  wall.vertices = {corner, corner + Vec3{a, 0, 0}, corner + Vec3{a, b, 0}, corner + Vec3{0, b, 0}};
  return wall;
}

TEST(MeshCheck, PlatesHaveTwoSidesWhereverTheyAre) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1), size(1e-3, 1e-2);
  for (int k = 0; k < 40000; ++k) {
    const Wall front = plate_at({place(random), place(random), place(random)}, size(random), size(random));
    Wall both = front;
    both.triangles =
        k % 2 ? std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}
              : std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}, {3, 1, 0}};
    EXPECT_TRUE(has_two_sides(both)) << k;
    EXPECT_FALSE(has_two_sides(front)) << k;
  }
}

TEST(MeshCheck, AClosedBodyHasOneSide) {
  Wall body;
  for (const Wall& side : box_walls({{0.3, 0.3, 0.3}, {0.4, 0.5, 0.6}})) {
    const auto first = static_cast<std::int32_t>(body.vertices.size());
    body.vertices.insert(body.vertices.end(), side.vertices.begin(), side.vertices.end());
    body.triangles.push_back({first, first + 1, first + 2});
    body.triangles.push_back({first, first + 2, first + 3});
  }
  EXPECT_FALSE(has_two_sides(body));
}

}  // namespace
}  // namespace granrad
