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
#include <functional>

#include "coupling/simulation/simulation.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/cover/wall_cover.h"
#include "dem/bed/wall_shape.h"
#include "dem/engine_native.h"
#include "raytrace/facets.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

constexpr double hot_K = 1000, cold_K = 300;
double exitance(double t) {
  return stefan_boltzmann * t * t * t * t;
}

using Move = std::function<Vec3(const Vec3&)>;
using Corners = std::vector<Vec3>;

std::string list(const Corners& corners) {
  std::string text;
  for (const Vec3& v : corners)
    text += fmt::format("{}[{:.17g}, {:.17g}, {:.17g}]", text.empty() ? "" : ", ", v.x, v.y, v.z);
  return "[" + text + "]";
}

std::string polygon(const std::string& name, const Corners& corners, double t) {
  return fmt::format(
      "[[polygon]]\nname = \"{}\"\nvertices_m = {}\nrole = \"isothermal\"\ntemperature_K = {}\nemissivity = 1\n",
      name, list(corners), t);
}

std::string mesh(const std::string& name, double t, const std::string& more = "") {
  return fmt::format(
      "[[mesh]]\nname = \"{0}\"\nfile = \"{0}.stl\"\nrole = \"isothermal\"\ntemperature_K = {1}\nemissivity = 1\n{2}",
      name, t, more);
}

std::string stl(const std::vector<Corners>& faces) {
  std::string text = "solid s\n";
  for (const auto& face : faces)
    for (std::size_t k = 2; k < face.size(); ++k) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const Vec3& v : {face[0], face[k - 1], face[k]})
        text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
      text += "endloop\nendfacet\n";
    }
  return text + "endsolid s\n";
}

Corners moved(const Corners& corners, const Move& move) {
  Corners all;
  for (const Vec3& v : corners) all.push_back(move(v));
  return all;
}

Corners reversed(Corners corners) {
  return {corners.rbegin(), corners.rend()};
}

const Box room{{0, 0, 0}, {0.01, 0.01, 0.01}};
const Corners patch{{0.003, 0.003, 0}, {0.007, 0.003, 0}, {0.007, 0.007, 0}, {0.003, 0.007, 0}};
const Vec3 above{0.005, 0.005, 0.002};  ///< 2 mm over the middle of the patch

std::string box_text(double t) {
  std::string text = "[box]\nsize_m = [0.01, 0.01, 0.01]\n";
  for (const auto& wall : box_walls(room))
    text +=
        fmt::format("[walls.{}]\nrole = \"isothermal\"\ntemperature_K = {}\nemissivity = 1\n", wall.name, t);
  return text;
}

std::string polygons_text(const Move& move, double t, bool backwards = false) {
  std::vector<std::string> all;
  for (const auto& wall : box_walls(room))
    all.push_back(polygon("wall_" + wall.name, moved(wall.vertices, move), t));
  if (backwards) std::reverse(all.begin(), all.end());
  std::string text;
  for (const auto& one : all) text += one;
  return text;
}

struct Written {
  std::string walls;
  Vec3 centre = above;
  double radius = 5e-4;
  std::map<std::string, std::string> files{};
};

/// Heat of the one sphere, W, its stated error, and what the program remarks.
struct Measured {
  double heat_W, error_W;
  std::string notes{};
};

/// Within four stated errors, and those small enough that an uncovered patch (half the heat and more) would stand out by
/// ten and more of them.
void expect_within(const Measured& found, double expected_W, double largest_error = 0.05) {
  EXPECT_LE(std::abs(found.heat_W - expected_W), 4 * found.error_W)
      << found.heat_W << " +- " << found.error_W << " for " << expected_W;
  EXPECT_LT(found.error_W, largest_error * expected_W);
}

Measured heat(const Written& scene, const std::string& source, double rays) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : scene.files) folder.write(name, text);
  folder.write("bed.csv", fmt::format("x,y,z,radius,temperature\n{:.17g},{:.17g},{:.17g},{},{}\n",
                                      scene.centre.x, scene.centre.y, scene.centre.z, scene.radius, cold_K));
  const auto file = folder.write(
      "scene.toml",
      fmt::format(
          "[scene]\nname = \"s\"\nend_time_s = 0.01\n[material]\ndensity_kg_m3 = 2500\n"
          "specific_heat_J_kgK = 800\nconductivity_W_mK = 1\nyoungs_modulus_Pa = 5e6\npoisson_ratio = 0.3\n"
          "restitution = 0.5\nfriction = 0.3\nemissivity = 1\n[particles]\nfile = \"bed.csv\"\n[dem]\nengine = "
          "\"none\"\n[conduction]\nsolid = false\n[radiation]\nsource = \"{}\"\nrays = {}\nevery_s = 0.01\n{}",
          source, rays, scene.walls));
  const Case c = read_case(file, {});
  Simulation simulation(c, 1);
  simulation.start();
  const auto drawn = simulation.draw_radiation(1);
  std::string notes;
  for (const auto& note : simulation.notes()) notes += note + "\n";
  return {drawn.heat_W.at(0), drawn.standard_error_W.at(0), notes};
}

const std::vector<std::pair<std::string, double>> sources = {
    {"paths", 30000}, {"embree", 6000}, {"lines", 12000}};

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
  // One radiosity for each wall: the two sides of a sheet would be one surface, and heat would pass through it.
  const Measured embree = heat(ways[0].second, "embree", 6000);
  EXPECT_LT(embree.error_W, 0.1 * embree.heat_W);
  for (const std::size_t k : {1u, 2u}) try {
      heat(ways[k].second, "embree", 1000);
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

TEST(WallsInOnePlace, WallsThatDifferInContactAreRefusedByName) {
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

TEST(WallsInOnePlace, BodyOnTheFloorHidesTheFloorAndItsOwnBottom) {
  auto walls = box_walls(room);
  std::vector<Wall> all(walls.begin(), walls.end());
  all.push_back(closed_box({{0.004, 0.005, 0}, {0.006, 0.007, 0.003}}, true));
  const double whole = total_area(all);
  cover_walls(all);
  EXPECT_NEAR(total_area(all), whole - 2 * 4e-6, 1e-15);
  EXPECT_NEAR(enclosed(all), 1e-6 - 12e-9, 1e-18);
}

TEST(WallsInOnePlace, SharedEdgesAreOneEdge) {
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

TEST(WallsInOnePlace, HeatPassesThroughEveryTouchedFaceAndOnceThroughASeam) {
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
TEST(WallsInOnePlace, EachSideOfAPlateConductsToItsOwnSide) {
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

TEST(WallsInOnePlace, ContactCountsOnce) {
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
