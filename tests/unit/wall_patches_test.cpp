// Requirement: walls are cut into patches that tile them, no longer than asked; points know their patch; walls that are
// not to be cut stay as they are. Planted, seen to fail: sides swapped in the search (points in the wrong patch); the
// first face of a mesh taken for the nearest.
#include "raytrace/wall_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dem/base/constants.h"
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
        const std::int32_t found = patches.at(w, point * (1 / total), point * (1 / total) + normal);
        EXPECT_EQ(patches.wall(found), w);
        EXPECT_TRUE(inside(patches.corners(found), normal, point * (1 / total)));
      }
    }
    EXPECT_NEAR(sum, area(walls[w]), 1e-12 * sum);
  }
}

/// The six faces of a box as one mesh that faces in, each of two triangles.
Wall vessel(const Vec3& size) {
  Wall mesh;
  for (const Wall& side : box_walls({{0, 0, 0}, size})) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), side.vertices.begin(), side.vertices.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

TEST(WallPatches, AVesselOfOneMeshIsCutFaceByFace) {
  const WallPatches patches({vessel({1, 2, 3})}, 0.5);
  EXPECT_EQ(patches.count(), 2 * (2 * 4 + 4 * 6 + 2 * 6));
  double sum = 0;
  for (std::int32_t p = 0; p < patches.count(); ++p) {
    const auto& corners = patches.corners(p);
    sum += polygon_area(corners);
    Vec3 middle{};
    for (const Vec3& c : corners) middle += (1.0 / static_cast<double>(corners.size())) * c;
    EXPECT_EQ(patches.at(0, middle, {0.5, 1, 1.5}), p);
    EXPECT_GT(dot(polygon_normal(corners), Vec3{0.5, 1, 1.5} - middle), 0) << "faces in";
  }
  EXPECT_NEAR(sum, 22, 1e-9);
}

TEST(WallPatches, TheSidesOfASheetAreToldApartByWhereTheyAreSeenFrom) {
  Wall sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  const WallPatches patches({sheet}, 0.5);
  EXPECT_EQ(patches.count(), 8);
  for (const double side : {-1.0, 1.0})
    for (const Vec3& point : {Vec3{0.2, 0.3, 0}, Vec3{0.7, 0.3, 1e-17}, Vec3{0.7, 0.9, -1e-17}}) {
      const auto p = patches.at(0, point, {5, 0.1, side});
      EXPECT_GT(side * polygon_normal(patches.corners(p)).z, 0);
      EXPECT_TRUE(inside(patches.corners(p), polygon_normal(patches.corners(p)), point));
    }
}

TEST(WallPatches, ABentFaceOfAMeshIsCutByTriangles) {
  Wall corner;  // an L of three squares in one plane
  corner.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}};
  corner.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {3, 4, 7}, {3, 7, 6}};
  const WallPatches patches({corner}, 10);
  EXPECT_EQ(patches.count(), 6);
  EXPECT_EQ(patches.at(0, {0.9, 0.1, 0}, {0.9, 0.1, 1}), 0);
}

TEST(WallPatches, LeaveFineMeshesAndOthersWhole) {
  Wall bent;  // a tube of very many facets
  constexpr int sides = 600;
  for (int k = 0; k < 2 * sides; ++k)
    bent.vertices.push_back(
        {std::cos(k / 2 * 2 * pi / sides), std::sin(k / 2 * 2 * pi / sides), k % 2 * 1.0});
  for (std::int32_t k = 0; k < 2 * sides; ++k)
    bent.triangles.push_back({k, (k + 1) % (2 * sides), (k + 2) % (2 * sides)});
  const std::vector<Wall> walls = {polygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}), bent};
  const WallPatches none(walls, 0.1, {0, 0}), fine_only(walls, 0.1, {0, 1});
  for (const WallPatches* patches : {&none, &fine_only}) {
    EXPECT_EQ(patches->count(), 2);
    for (std::int32_t w : {0, 1}) {
      EXPECT_FALSE(patches->is_cut(w));
      EXPECT_EQ(patches->at(w, {0.5, 0.5, 0}, {0.5, 0.5, 1}), w);
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
