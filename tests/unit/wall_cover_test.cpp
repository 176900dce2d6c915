// Requirement: a patch drawn on a wall of the box heats whatever its winding and the last digits of its plane, and a
// plate that could be meant to face away is left as it is.
// A block of six plates on the floor hides the floor under it. Planted, seen to fail: patches not turned; not moved
// into the plane; the foot of a block taken for a patch.
#include "dem/cover/wall_cover.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dem/bed/wall_shape.h"

namespace granrad {
namespace {

Wall plate(const std::string& name, double z, bool up) {
  Wall wall;
  wall.name = name;
  wall.vertices = {{0.2, 0.3, z}, {0.7, 0.3, z}, {0.7, 0.6, z}, {0.2, 0.6, z}};
  if (!up) std::reverse(wall.vertices.begin(), wall.vertices.end());
  return wall;
}

std::vector<Wall> box_with(const Wall& wall) {
  std::vector<Wall> walls;
  for (const auto& side : box_walls({{0, 0, 0}, {1, 1, 1}})) walls.push_back(side);
  walls.push_back(wall);
  return walls;
}

TEST(WallCover, APatchOnAWallFacesInAndLiesInItsPlane) {
  for (const double z : {0.0, 2e-7, -2e-7})
    for (const bool up : {true, false}) {
      auto walls = box_with(plate("patch", z, up));
      const auto cover = cover_walls(walls);
      ASSERT_EQ(walls.size(), 7u);
      EXPECT_GT(plane_of(walls[6])->normal.z, 0.999) << z << up;
      for (const auto& v : walls[6].vertices) EXPECT_EQ(v.z, 0) << z << up;
      EXPECT_NEAR(area(walls[4]), 1 - 0.15, 1e-12) << z << up;
      const bool told = std::any_of(cover.notes.begin(), cover.notes.end(),
                                    [](const auto& note) { return note.find("was turned") != note.npos; });
      EXPECT_EQ(told, !up);
    }
}

/// Six plates that face out of the box between two corners.
std::vector<Wall> block(const Vec3& low, const Vec3& high) {
  std::vector<Wall> sides;
  for (Wall side : box_walls({low, high})) {
    flip(side);
    side.name = "block " + side.name;
    sides.push_back(side);
  }
  return sides;
}

TEST(WallCover, ABlockOfPlatesHidesTheFloorUnderIt) {
  for (const bool turned : {false, true}) {  // upside down: it hangs from the lid
    auto walls = box_with({});
    walls.pop_back();
    for (auto& side : turned ? block({0.2, 0.3, 0.4}, {0.7, 0.6, 1}) : block({0.2, 0.3, 0}, {0.7, 0.6, 0.4}))
      walls.push_back(side);
    const auto cover = cover_walls(walls);
    ASSERT_EQ(walls.size(), 11u) << "the foot is gone";
    for (const auto& wall : walls) EXPECT_NE(wall.name, turned ? "block z_max" : "block z_min");
    EXPECT_NEAR(area(walls[turned ? 5 : 4]), 1 - 0.15, 1e-12);
    for (const auto& note : cover.notes) EXPECT_EQ(note.find("turned"), note.npos) << note;
  }
}

TEST(WallCover, ATrayOfPlatesOnTheFloorKeepsItsBottom) {
  auto walls = box_with({});
  walls.pop_back();
  for (auto& side : block({0.2, 0.3, 0}, {0.7, 0.6, 0.4})) {
    flip(side);  // filled from above
    if (side.name != "block z_max") walls.push_back(side);
  }
  cover_walls(walls);
  ASSERT_EQ(walls.size(), 11u);
  EXPECT_NEAR(area(walls[4]), 1 - 0.15, 1e-12);
  EXPECT_NEAR(area(walls[10]), 0.15, 1e-12);
}

TEST(WallCover, PlatesBackToBackInTheVoidStay) {
  auto walls = box_with(plate("below", 0.5, false));
  walls.push_back(plate("above", 0.5, true));
  cover_walls(walls);
  ASSERT_EQ(walls.size(), 8u);
  EXPECT_LT(plane_of(walls[6])->normal.z, -0.999);
  EXPECT_GT(plane_of(walls[7])->normal.z, 0.999);
}

TEST(WallCover, APlateAloneMayFaceAnyWay) {
  std::vector<Wall> walls{plate("one", 0, true), plate("other", 0, false)};
  cover_walls(walls);
  ASSERT_EQ(walls.size(), 2u);
  EXPECT_LT(plane_of(walls[1])->normal.z, -0.999);
}

}  // namespace
}  // namespace granrad
