// Requirement: walls that lie in one place are one surface for conduction and contact, and nothing of it is counted twice:
// what a body covers is cut from both, a sphere that touches three faces gets three times what one face gives, one that lies
// over a seam what one floor gives. Planted errors: see walls_in_one_place_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "coupling/heat/conduction.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/cover/wall_cover.h"
#include "dem/engine_native.h"
#include "raytrace/facets.h"
#include "tests/physics/written_walls.h"

namespace granrad {
namespace {

using written_walls::patch, written_walls::reversed, written_walls::room;

TEST(TouchesInOnePlace, WallsThatDifferInContactAreRefusedByName) {
  auto walls = box_walls(room);
  std::vector<Wall> all(walls.begin(), walls.end());
  Wall heater{.name = "heater", .vertices = patch, .contact = false};
  all.push_back(heater);
  try {
    cover_walls(all);
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("heater"), std::string::npos) << text;
    EXPECT_NE(text.find("z_min"), std::string::npos) << text;
  }
}

double total_area(const std::vector<Wall>& walls) {
  double sum = 0;
  for (const auto& wall : walls) sum += area(wall);
  return sum;
}

double enclosed(const std::vector<Wall>& walls) {
  Facets facets(0);
  for (const auto& wall : walls) facets.add(wall, 0, {}, 1);
  return facets.enclosed_volume({}).value_or(0);
}

Wall closed_box(const Box& box, bool outward) {
  Wall wall{.name = "body"};
  std::vector<WallFace> faces;
  for (auto& side : box_walls(box)) {
    if (outward) flip(side);
    faces.push_back(make_face(side.vertices));
  }
  set_faces(wall, faces);
  return wall;
}

TEST(TouchesInOnePlace, BodyOnTheFloorHidesTheFloorAndItsOwnBottom) {
  auto walls = box_walls(room);
  std::vector<Wall> all(walls.begin(), walls.end());
  all.push_back(closed_box({{0.004, 0.005, 0}, {0.006, 0.007, 0.003}}, true));
  const double whole = total_area(all);
  cover_walls(all);
  EXPECT_NEAR(total_area(all), whole - 2 * 4e-6, 1e-15);
  EXPECT_NEAR(enclosed(all), 1e-6 - 12e-9, 1e-18);
}

TEST(TouchesInOnePlace, SharedEdgesAreOneEdge) {
  // A patch over a corner of the floor, and one over the seam of two walls' edge: pieces and walls have the same edges.
  auto walls = box_walls(room);
  std::vector<Wall> all(walls.begin(), walls.end());
  all.push_back({.name = "a", .vertices = {{0, 0, 0}, {0.004, 0, 0}, {0.004, 0.003, 0}, {0, 0.003, 0}}});
  all.push_back({.name = "b",
                 .vertices = {{0.002, 0.001, 0}, {0.009, 0.001, 0}, {0.009, 0.002, 0}, {0.002, 0.002, 0}}});
  cover_walls(all);
  EXPECT_NEAR(total_area(all), 6e-4, 1e-15);
  std::map<std::array<double, 6>, int> balance;
  for (const auto& wall : all)
    for (const auto& face : faces_of(wall))
      for (std::size_t k = 0; k < face.vertices.size(); ++k) {
        const Vec3 &p = face.vertices[k], &q = face.vertices[(k + 1) % face.vertices.size()];
        ++balance[{p.x, p.y, p.z, q.x, q.y, q.z}];
        --balance[{q.x, q.y, q.z, p.x, p.y, p.z}];
      }
  for (const auto& [edge, count] : balance) EXPECT_EQ(count, 0);
}

/// Conductances to walls of a sphere of radius 1 mm that touches them by 10 micrometres, over that of one floor.
std::pair<double, double> conducted(std::vector<Wall> walls, const Vec3& centre) {
  Bed bed;
  Material m;
  m.conductivity_W_mK = 1, m.youngs_modulus_Pa = 5e6, m.real_youngs_modulus_Pa = 5e10, m.poisson_ratio = 0.3;
  bed.materials = {m};
  for (auto& wall : walls) wall.role = WallRole::isothermal;
  bed.walls = std::move(walls);
  bed.box = room;
  bed.add(centre, {}, 1e-3, 300);
  ConductionSettings settings;
  settings.gas = GasLens{};
  double solid = 0, gas = 0;
  for (const auto& g : conductances(bed, near_pairs(bed, lens_cutoff_gap_m(settings, 1e-3)), settings).walls)
    solid += g.solid_W_K, gas += g.gas_W_K;
  return {solid, gas};
}

TEST(TouchesInOnePlace, HeatPassesThroughEveryTouchedFaceAndOnceThroughASeam) {
  const double in = 1e-3 - 1e-5;
  auto box = box_walls(room);
  const std::vector<Wall> six(box.begin(), box.end());
  const auto [solid, gas] = conducted(six, {0.005, 0.005, in});
  ASSERT_GT(solid, 0);
  const Wall vessel = closed_box(room, false);
  for (const auto& [name, walls] : {std::pair{"box", six}, std::pair{"mesh", std::vector{vessel}}}) {
    SCOPED_TRACE(name);
    const auto edge = conducted(walls, {0.005, in, in}), corner = conducted(walls, {in, in, in});
    EXPECT_NEAR(edge.first, 2 * solid, 1e-9 * solid);
    EXPECT_NEAR(edge.second, 2 * gas, 1e-9 * gas);
    EXPECT_NEAR(corner.first, 3 * solid, 1e-9 * solid);
    EXPECT_NEAR(corner.second, 3 * gas, 1e-9 * gas);
  }
  // A floor of two and of three polygons, with a T where their edges meet, and of two lying in each other.
  const Wall left{.name = "left", .vertices = {{0, 0, 0}, {0.005, 0, 0}, {0.005, 0.01, 0}, {0, 0.01, 0}}};
  const Wall right{.name = "right",
                   .vertices = {{0.005, 0, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}, {0.005, 0.01, 0}}};
  const Wall low{.name = "low",
                 .vertices = {{0.005, 0, 0}, {0.01, 0, 0}, {0.01, 0.005, 0}, {0.005, 0.005, 0}}};
  const Wall high{.name = "high",
                  .vertices = {{0.005, 0.005, 0}, {0.01, 0.005, 0}, {0.01, 0.01, 0}, {0.005, 0.01, 0}}};
  std::vector<Wall> patched = six;
  patched.push_back({.name = "patch", .vertices = patch});
  cover_walls(patched);
  for (const auto& floor : {std::vector{left, right}, std::vector{left, low, high}, patched})
    for (const Vec3& at :
         {Vec3{0.005, 0.005, in}, {0.005, 0.0043, in}, {0.0050004, 0.0049998, in}, {0.003, 0.004, in}}) {
      const auto seam = conducted(floor, at);
      EXPECT_NEAR(seam.first, solid, 1e-6 * solid);
      EXPECT_NEAR(seam.second, gas, 1e-6 * gas);
    }
}

/// Heat passes to the side of a plate that faces the particle.
TEST(TouchesInOnePlace, EachSideOfAPlateConductsToItsOwnSide) {
  const Wall up{.name = "up", .vertices = patch};
  Wall down{.name = "down", .vertices = reversed(patch)};
  Bed bed;
  bed.materials.emplace_back();
  bed.walls = {up, down};
  bed.box = room;
  bed.add({0.005, 0.005, 0.0009}, {}, 1e-3, 300);
  bed.add({0.005, 0.005, -0.0009}, {}, 1e-3, 300);
  const auto near = near_pairs(bed, 0);
  ASSERT_EQ(near.walls.size(), 2u);
  EXPECT_EQ(near.walls[0].wall, 0);
  EXPECT_EQ(near.walls[1].wall, 1);
}

/// A sphere that comes to rest: how deep it lies in its floor, m.
double static_overlap(const std::vector<Wall>& walls, const Vec3& centre) {
  Bed bed;
  Material m;
  m.density_kg_m3 = 2500, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.3, m.restitution = 0.3;
  bed.materials = {m};
  bed.walls = walls;
  bed.box = room;
  bed.add(centre, {}, 1e-3, 300);
  make_native_engine(bed, {0, 0, -9.81}, 1e-5, 1)->advance(bed, 0.3);
  return 1e-3 - bed.position_m[0].z;
}

TEST(TouchesInOnePlace, ContactCountsOnce) {
  auto box = box_walls(room);
  std::vector<Wall> walls(box.begin(), box.end());
  const Vec3 start{0.005, 0.005, 1e-3};
  const double bare = static_overlap(walls, start);
  // Hertz: F = 4/3 E* sqrt(R) d^1.5, both of the one material
  const double modulus = 5e6 / (2 * (1 - 0.09)), weight = 2500 * 4.0 / 3 * pi * 1e-9 * 9.81;
  EXPECT_NEAR(bare, std::pow(weight / (4.0 / 3 * modulus * std::sqrt(1e-3)), 2.0 / 3), 1e-3 * bare);
  std::vector<Wall> laid = walls;
  laid.push_back({.name = "patch", .vertices = patch});
  std::vector<Wall> twice = laid;  // as an engine may meet it
  cover_walls(laid);
  Wall down{.name = "down", .vertices = reversed(patch)};
  std::vector<Wall> plate{{.name = "up", .vertices = patch}, down};
  EXPECT_NEAR(static_overlap(laid, start), bare, 1e-9 * bare);
  EXPECT_NEAR(static_overlap(laid, {0.003, 0.005, 1e-3}), bare, 1e-9 * bare)
      << "over the border of the patch";
  EXPECT_NEAR(static_overlap(twice, start), bare, 1e-9 * bare);
  EXPECT_NEAR(static_overlap(plate, start), bare, 1e-9 * bare);
}

}  // namespace
}  // namespace granrad
