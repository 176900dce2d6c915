// Requirement: walls that lie in one place are one surface, the later on top, for every source of radiation, for
// conduction and for contact, however the same scene is written: moved, turned, scaled, with walls as box, polygons
// or STL. A plate seen from both sides radiates from both, or is refused by every source.
//
// Truths: the heat of a small black sphere between black walls is A sigma sum_w F_w (T_w^4 - T^4), F the solid angle
// of the wall at the centre / 4 pi (exact for planar walls); of a black vessel of one temperature A sigma (T_w^4 -
// T^4). Conduction: a sphere that touches three faces gets three times what one face gives.
//
// Planted, seen: the covered part left in place (paths give the patch a hundredth of its heat); the later wall cut
// instead of the earlier (the patch vanishes); a sheet of two sides traced without the normal of its start; touches at
// one point not told to be one (a seam heats twice, the contact counts twice); near walls by wall, not by feature (a corner
// of one mesh conducts a third).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "tests/physics/written_walls.h"

namespace granrad {
namespace {

using namespace written_walls;

TEST(WallsInOnePlace, PatchGivesItsSolidAngleHoweverTheSceneIsWritten) {
  const double a = 0.002, h = 0.002, solid_angle = 4 * std::atan(a * a / (h * std::sqrt(2 * a * a + h * h)));
  const double expected = 5e-4 * 5e-4 * solid_angle * (exitance(hot_K) - exitance(cold_K));
  const Move stay = [](const Vec3& p) { return p; };
  const Move turned = [](const Vec3& p) { return Vec3{p.z, p.x, p.y} + Vec3{1, 2, -3}; };
  const Move tilted = [](const Vec3& p) { return Vec3{0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y, p.z}; };
  const Move large = [](const Vec3& p) { return 10.0 * p; };
  const auto as_polygons = [&](const Move& move, double scale, bool backwards) {
    return Written{polygons_text(move, cold_K, backwards) + polygon("patch", moved(patch, move), hot_K),
                   move(above), 5e-4 * scale};
  };
  std::vector<Corners> vessel;
  for (const auto& wall : box_walls(room)) vessel.push_back(wall.vertices);
  const std::vector<std::pair<std::string, Written>> ways = {
      {"on the box", {box_text(cold_K) + polygon("patch", patch, hot_K)}},
      {"as STL", {box_text(cold_K) + mesh("patch", hot_K), above, 5e-4, {{"patch.stl", stl({patch})}}}},
      {"on polygons", as_polygons(stay, 1, false)},
      {"on polygons, backwards", as_polygons(stay, 1, true)},
      {"turned and moved", as_polygons(turned, 1, false)},
      {"tilted", as_polygons(tilted, 1, false)},
      {"ten times as large", as_polygons(large, 10, false)},
      {"on an STL vessel",
       {mesh("vessel", cold_K) + polygon("patch", patch, hot_K), above, 5e-4, {{"vessel.stl", stl(vessel)}}}},
      {"on an STL vessel in a box",
       {box_text(700) + mesh("vessel", cold_K) + polygon("patch", patch, hot_K),
        above,
        5e-4,
        {{"vessel.stl", stl(vessel)}}}},
      {"twice", {box_text(cold_K) + polygon("patch", patch, 700) + polygon("again", patch, hot_K)}},
      {"in two halves",
       {box_text(cold_K) +
        polygon("left", {patch[0], {0.005, 0.003, 0}, {0.005, 0.007, 0}, patch[3]}, hot_K) +
        polygon("right", {{0.005, 0.003, 0}, patch[1], patch[2], {0.005, 0.007, 0}}, hot_K)}},
  };
  for (const auto& [name, scene] : ways)
    for (const auto& [source, rays] : sources) {
      if (source == "lines" && name.find("STL vessel") != std::string::npos) continue;  // no planar walls
      SCOPED_TRACE(name + ", " + source);
      const double scale = scene.radius / 5e-4;
      expect_within(heat(scene, source, rays), scale * scale * expected);
    }
}

TEST(WallsInOnePlace, VesselOfTheSizeOfTheBoxIsTheVessel) {
  std::vector<Corners> vessel;
  for (const auto& wall : box_walls(room)) vessel.push_back(wall.vertices);
  const Written scene{box_text(cold_K) + mesh("vessel", hot_K), above, 5e-4, {{"vessel.stl", stl(vessel)}}};
  const double expected = 4 * pi * 5e-4 * 5e-4 * (exitance(hot_K) - exitance(cold_K));
  expect_within(heat(scene, "paths", 50000), expected, 0.01);
  EXPECT_NEAR(heat(scene, "embree", 2000).heat_W, expected, 1e-9 * expected);
}

/// A hot plate in the middle of a cold room, 4 mm square, and the sphere before its one or its other side.
TEST(WallsInOnePlace, PlateOfTwoSidesRadiatesFromBoth) {
  const Corners plate{
      {0.003, 0.003, 0.005}, {0.007, 0.003, 0.005}, {0.007, 0.007, 0.005}, {0.003, 0.007, 0.005}};
  const double a = 0.002, h = 0.002, solid_angle = 4 * std::atan(a * a / (h * std::sqrt(2 * a * a + h * h)));
  const double expected = 5e-4 * 5e-4 * solid_angle * (exitance(hot_K) - exitance(cold_K));
  std::string both = polygon("plate", plate, hot_K) + "two_sided = true\n";
  const std::vector<std::pair<std::string, Written>> ways = {
      {"two polygons", {polygon("up", plate, hot_K) + polygon("down", reversed(plate), hot_K)}},
      {"two_sided", {both}},
      {"one STL", {mesh("sheet", hot_K), above, 5e-4, {{"sheet.stl", stl({plate, reversed(plate)})}}}},
      {"one STL, two_sided",
       {mesh("sheet", hot_K, "two_sided = true\n"), above, 5e-4, {{"sheet.stl", stl({plate})}}}},
  };
  for (const auto& [name, scene] : ways)
    for (const double z : {0.003, 0.007})
      for (const std::string source : {"paths", "embree"}) {
        SCOPED_TRACE(fmt::format("{}, {}, z = {}", name, source, z));
        Written placed = scene;
        placed.walls = box_text(cold_K) + scene.walls;
        placed.centre.z = z;
        expect_within(heat(placed, source, source == "paths" ? 30000 : 6000), expected);
      }
}

TEST(WallsInOnePlace, PlateOfOneSideSeenFromBehindIsRefusedByEverySource) {
  const Corners plate{
      {0.003, 0.003, 0.005}, {0.007, 0.003, 0.005}, {0.007, 0.007, 0.005}, {0.003, 0.007, 0.005}};
  for (const std::string source : {"paths", "embree"}) {
    Written scene{box_text(cold_K) + polygon("plate", plate, hot_K), {0.005, 0.005, 0.003}};
    try {
      heat(scene, source, 1000);
      ADD_FAILURE() << source << " took it";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("plate"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("two_sided"), std::string::npos) << error.what();
    }
  }
}

/// Sixty seeds: no bias beyond the error of their mean, and stated errors that are those of the scatter.
TEST(WallsInOnePlace, PatchByPathsHasNoBiasAndTrueErrors) {
  const double a = 0.002, h = 0.005, solid_angle = 4 * std::atan(a * a / (h * std::sqrt(2 * a * a + h * h)));
  const double expected = 1e-6 * solid_angle * (exitance(hot_K) - exitance(cold_K));  // 0.03113 W
  constexpr int seeds = 60;
  double sum = 0, squares = 0, stated = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Written scene{fmt::format("seed = {}\n", seed) + box_text(cold_K) + polygon("patch", patch, hot_K),
                        {0.005, 0.005, 0.005},
                        1e-3};
    const auto [found, error, notes] = heat(scene, "paths", 5000);
    sum += found, squares += (found - expected) * (found - expected), stated += error * error;
  }
  EXPECT_LT(std::abs(sum / seeds - expected), 3 * std::sqrt(stated) / seeds);
  EXPECT_GT(squares / stated, 0.57);  // chi^2 of 60: 0.59 to 1.53 in 99 of 100
  EXPECT_LT(squares / stated, 1.55);
  EXPECT_LT(std::sqrt(stated / seeds), 0.1 * expected);
}

/// An adiabatic baffle, thin, seen from both sides, between a hot and a cold wall: it must end, and give the sphere what
/// the same baffle as two polygons gives.
TEST(WallsInOnePlace, AdiabaticBaffleOfTwoSidesIsTheSameAsSheetAndPolygons) {
  const Corners plate{
      {0.005, 0.005, 0.001}, {0.005, 0.009, 0.001}, {0.005, 0.009, 0.009}, {0.005, 0.005, 0.009}};
  std::string room_text = "[box]\nsize_m = [0.01, 0.01, 0.01]\n";
  for (const auto& wall : box_walls(room))
    room_text += fmt::format("[walls.{}]\nrole = \"isothermal\"\ntemperature_K = {}\nemissivity = 1\n",
                             wall.name, wall.name == "x_min" ? hot_K : cold_K);
  const auto adiabatic = [](const std::string& name, const Corners& corners) {
    return fmt::format("[[polygon]]\nname = \"{}\"\nvertices_m = {}\nrole = \"adiabatic\"\n", name,
                       list(corners));
  };
  const auto sheet = [](const std::string& more) {
    return "[[mesh]]\nname = \"sheet\"\nfile = \"sheet.stl\"\nrole = \"adiabatic\"\n" + more;
  };
  const Vec3 behind{0.008, 0.005, 0.005};  // half in the shadow
  const std::vector<std::pair<std::string, Written>> ways = {
      {"polygons", {room_text + adiabatic("left", plate) + adiabatic("right", reversed(plate)), behind}},
      {"sheet", {room_text + sheet(""), behind, 5e-4, {{"sheet.stl", stl({plate, reversed(plate)})}}}},
      {"two_sided", {room_text + sheet("two_sided = true\n"), behind, 5e-4, {{"sheet.stl", stl({plate})}}}},
  };
  const Measured none = heat({room_text, behind}, "paths", 30000),
                 first = heat(ways[0].second, "paths", 30000);
  EXPECT_LT(first.heat_W, 0.7 * none.heat_W) << "it shades";
  EXPECT_GT(first.heat_W, 0.05 * none.heat_W);
  for (const auto& [name, scene] : ways) {
    SCOPED_TRACE(name);
    const Measured paths = heat(scene, "paths", 30000);
    EXPECT_LE(std::abs(paths.heat_W - first.heat_W), 4 * std::hypot(paths.error_W, first.error_W));
    EXPECT_LT(paths.error_W, 0.1 * first.heat_W);
  }
  // Patches of one side are surfaces of their own; with one radiosity for both sides heat would pass through. Planted: a
  // patch by its place alone -> refused, as the exchange of the sides is not reciprocal.
  for (const auto& [name, scene] : ways)
    for (const auto& [source, rays] : {std::pair<std::string, double>{"embree", 4000}, {"shading", 20000}}) {
      SCOPED_TRACE(name + ", " + source);
      const Measured found = heat(scene, source, rays);
      EXPECT_LE(std::abs(found.heat_W - first.heat_W), 4 * std::hypot(found.error_W, first.error_W));
      EXPECT_LT(found.error_W, 0.1 * found.heat_W);
    }
  for (const std::size_t k : {1u, 2u}) try {
      Written whole = ways[k].second;
      whole.walls = "wall_patches = \"whole\"\n" + whole.walls;
      heat(whole, "embree", 1000);
      ADD_FAILURE() << ways[k].first << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("sheet has two sides"), std::string::npos) << error.what();
    }
}

/// Meshes as CAD writes them: normals out of the vessel, a corner of a neighbour on an edge, a facet twice, one without
/// area. The same heat as the box, each said; a body with the sphere outside of it stays as it is.
TEST(WallsInOnePlace, VesselsAsTheyComeAreMendedAndTurnedWithANote) {
  const auto vessel = [](bool outward, bool rough) {
    std::vector<Corners> faces;
    for (const auto& wall : box_walls(room)) {
      const bool floor = wall.name == "z_min";
      Corners face = wall.vertices;
      if (outward) face = reversed(face);
      if (!(floor && rough)) {
        faces.push_back(face);
        continue;
      }
      const Vec3 middle = 0.5 * (face[0] + face[1]);  // on an edge of the neighbour
      faces.push_back({middle, face[1], face[2], face[3]});
      faces.push_back({face[0], middle, face[3]});
      faces.push_back({face[0], middle, face[3]});
      faces.push_back({face[0], face[0], face[1]});
    }
    return stl(faces);
  };
  const auto written = [&](bool outward, bool rough) {
    return Written{mesh("vessel", hot_K) + "[surroundings]\ntemperature_K = 300\n",
                   above,
                   5e-4,
                   {{"vessel.stl", vessel(outward, rough)}}};
  };
  const double expected = 4 * pi * 5e-4 * 5e-4 * (exitance(hot_K) - exitance(cold_K));
  for (const std::string source : {"paths", "embree"})
    for (const bool rough : {false, true}) {
      const Measured in = heat(written(false, rough), source, 5000),
                     out = heat(written(true, rough), source, 5000);
      EXPECT_LE(std::abs(in.heat_W - expected), 4 * in.error_W + 1e-9 * expected);
      EXPECT_LE(std::abs(out.heat_W - expected), 4 * out.error_W + 1e-9 * expected);
      EXPECT_NE(out.notes.find("vessel faced away from the particles and was turned"), std::string::npos)
          << out.notes;
      EXPECT_EQ(in.notes.find("turned"), std::string::npos) << in.notes;
      if (!rough) continue;
      EXPECT_NE(in.notes.find("without area"), std::string::npos) << in.notes;
      EXPECT_NE(in.notes.find("given twice"), std::string::npos) << in.notes;
      EXPECT_NE(in.notes.find("cut at corners"), std::string::npos) << in.notes;
    }
  std::vector<Corners> body;
  for (const auto& wall : box_walls({{0.004, 0.004, 0.006}, {0.006, 0.006, 0.008}}))
    body.push_back(reversed(wall.vertices));
  const Written with_body{box_text(hot_K) + mesh("body", hot_K), above, 5e-4, {{"body.stl", stl(body)}}};
  const Measured beside = heat(with_body, "embree", 5000);
  EXPECT_NEAR(beside.heat_W, expected, 1e-9 * expected);
  EXPECT_EQ(beside.notes.find("turned"), std::string::npos) << beside.notes;
}

}  // namespace
}  // namespace granrad
