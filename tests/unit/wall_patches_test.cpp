// Requirement: walls are cut into patches that tile them, no longer than asked; points know their patch; walls that are
// not to be cut stay as they are. Planted, seen to fail: sides swapped in the search (points in the wrong patch).
#include "raytrace/wall_patches.h"

#include <gtest/gtest.h>

#include <random>

#include "dem/bed/wall_shape.h"

namespace granrad {
namespace {

Wall polygon(std::vector<Vec3> vertices) {
  Wall wall;
  wall.vertices = std::move(vertices);
  return wall;
}

bool inside(const std::vector<Vec3>& corners, const Vec3& normal, const Vec3& p) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    if (dot(cross(normal, b - a), p - a) < -1e-12) return false;
  }
  return true;
}

double longest(const std::vector<Vec3>& corners, const Vec3& along) {
  double low = 1e300, high = -1e300;
  for (const Vec3& p : corners) low = std::min(low, dot(along, p)), high = std::max(high, dot(along, p));
  return high - low;
}

TEST(WallPatches, TileEveryWallAndFindTheirPoints) {
  const std::vector<Wall> walls = {polygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}),
                                   polygon({{0, 0, 0}, {2, 0, 1}, {1, 2, 2}}),
                                   polygon({{0, 0, 0}, {0, 4, 0}, {0, 3, 1}, {0, 1, 1}})};
  const double size = 0.3;
  const WallPatches patches(walls, size);
  EXPECT_EQ(patches.wall(patches.first(1) - 1), 0);
  EXPECT_EQ(patches.first(1), 10 * 4);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  for (std::int32_t w = 0; w < 3; ++w) {
    const Vec3 normal = plane_of(walls[w])->normal,
               u = normalized(walls[w].vertices[1] - walls[w].vertices[0]);
    double sum = 0;
    for (std::int32_t p = 0; p < patches.count(); ++p) {
      if (patches.wall(p) != w) continue;
      const auto& corners = patches.corners(p);
      sum += polygon_area(corners);
      EXPECT_GT(dot(polygon_normal(corners), normal), 1 - 1e-12);
      EXPECT_LE(longest(corners, u), size * (1 + 1e-8));
      EXPECT_LE(longest(corners, cross(normal, u)), size * (1 + 1e-8));
      for (int k = 0; k < 20; ++k) {
        Vec3 point{};
        double total = 0;
        for (const Vec3& c : corners) {
          const double share = uniform(random);
          point += share * c, total += share;
        }
        const std::int32_t found = patches.at(w, point * (1 / total));
        EXPECT_EQ(patches.wall(found), w);
        EXPECT_TRUE(inside(patches.corners(found), normal, point * (1 / total)));
      }
    }
    EXPECT_NEAR(sum, area(walls[w]), 1e-12 * sum);
  }
}

TEST(WallPatches, LeaveOthersWhole) {
  Wall bent = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}});
  bent.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Wall> walls = {polygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}), bent};
  const WallPatches none(walls, 0.1, {0, 0}), bent_only(walls, 0.1, {0, 1});
  for (const WallPatches* patches : {&none, &bent_only}) {
    EXPECT_EQ(patches->count(), 2);
    for (std::int32_t w : {0, 1}) {
      EXPECT_FALSE(patches->is_cut(w));
      EXPECT_EQ(patches->at(w, {0.5, 0.5, 0}), w);
    }
  }
  Enclosure enclosure;
  enclosure.walls = walls;
  const Enclosure same = none.applied_to(enclosure);
  EXPECT_EQ(same.walls[1].triangles, bent.triangles);
  EXPECT_EQ(same.walls[0].vertices.size(), 4u);
}

}  // namespace
}  // namespace granrad
