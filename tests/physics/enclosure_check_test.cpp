// Requirement: before anything is computed an enclosure is looked at, the same for every program and source: holes,
// turned faces, plates seen from behind, particles outside, walls in other units. A sound one passes without a word, and
// a mesh that faces away from its bed is turned.
//
// Planted, seen to fail: rays that meet the back of a wall not counted.
#include "raytrace/rays/enclosure_check.h"

#include <gtest/gtest.h>

#include "dem/bed/wall_shape.h"
#include "tests/enclosures.h"

namespace granrad {
namespace {

Enclosure with_spheres() {
  return boxed(spheres_in_open_space({{0.003, 0.002, 0.01}, {0.006, 0.002, 0.03}}, {4e-4, 4e-4}), channel());
}

Wall as_mesh(const Box& box) {
  Wall wall{.name = "vessel"};
  std::vector<WallFace> faces;
  for (auto& side : box_walls(box)) faces.push_back(make_face(side.vertices));
  set_faces(wall, faces);
  return wall;
}

Enclosure in_mesh(const Wall& mesh) {
  Enclosure e = spheres_in_open_space({{0.003, 0.002, 0.01}, {0.006, 0.002, 0.03}}, {4e-4, 4e-4});
  e.walls = {mesh};
  e.wall = {0};
  e.box = channel();
  return e;
}

bool mentions(const std::vector<std::string>& texts, const std::string& words) {
  for (const auto& text : texts)
    if (text.find(words) != std::string::npos) return true;
  return false;
}

TEST(EnclosureCheck, ASoundEnclosurePasses) {
  for (const auto& e : {with_spheres(), in_mesh(as_mesh(channel()))}) {
    const auto check = check_enclosure(e);
    EXPECT_TRUE(check.problems.empty()) << check.problems[0];
    EXPECT_TRUE(check.notes.empty());
    EXPECT_EQ(check.open, 0);
    EXPECT_GT(check.rays, 500);
  }
}

TEST(EnclosureCheck, AHoleLetsRaysOut) {
  Wall holed = as_mesh(channel());
  holed.triangles.pop_back();
  const auto check = check_enclosure(in_mesh(holed));
  EXPECT_GT(check.open, 10);
  EXPECT_FALSE(check.leaves_most.empty());
}

TEST(EnclosureCheck, ATurnedFaceIsNamed) {
  Wall mesh = as_mesh(channel());
  std::swap(mesh.triangles[3][1], mesh.triangles[3][2]);
  EXPECT_TRUE(mentions(check_enclosure(in_mesh(mesh)).problems, "vessel shows its back"));
}

TEST(EnclosureCheck, AMeshThatFacesAwayIsTurned) {
  Wall mesh = as_mesh(channel());
  flip(mesh);
  const Enclosure e = in_mesh(mesh);
  std::vector<Wall> walls = e.walls;
  const auto check = check_enclosure(e);
  EXPECT_FALSE(check.problems.empty());
  EXPECT_EQ(turn_walls_to_particles(walls, check, e).size(), 1u);
  EXPECT_TRUE(check_enclosure(in_mesh(walls[0])).problems.empty());
}

TEST(EnclosureCheck, ParticlesOutsideAreCounted) {
  Enclosure e = with_spheres();
  e.centre_m[1] = {0.1, 0.1, 0.1};
  const auto check = check_enclosure(e, {7, 8});
  EXPECT_TRUE(mentions(check.problems, "1 of 2 particles looked at are outside the walls"));
  EXPECT_TRUE(mentions(check.problems, ": 8"));
}

TEST(EnclosureCheck, WallsInOtherUnitsAreNoticed) {
  const Box metres{{0, 0, 0}, {10, 4, 50}};
  EXPECT_TRUE(mentions(check_enclosure(in_mesh(as_mesh(metres))).notes, "scale = 0.001"));
}

TEST(EnclosureCheck, BodiesThatReachIntoEachOtherAreNamed) {
  Enclosure e = with_spheres();
  for (const double x : {0.004, 0.005}) {
    Wall body = as_mesh({{x, 0.001, 0.015}, {x + 0.002, 0.003, 0.02}});
    flip(body);
    body.name = x < 0.0045 ? "one" : "other";
    e.walls.push_back(body);
    e.wall.push_back(static_cast<std::int32_t>(e.wall.size()));
  }
  const auto problems = check_enclosure(e).problems;
  EXPECT_TRUE(mentions(problems, "one shows its back to wall other") ||
              mentions(problems, "other shows its back to wall one"));
}

}  // namespace
}  // namespace granrad
