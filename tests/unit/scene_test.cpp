// A scene is complete, derived where it can be, and refused with every problem at its place where it is
// wrong.
#include "dem/scene/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "tests/source_dir.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

// Line 1 holds the name of the scene; tests that count lines rely on it.
const std::string material =
    "[material]\ndensity_kg_m3 = 3984\nspecific_heat_J_kgK = 755\nconductivity_W_mK = 33\n"
    "youngs_modulus_Pa = \"5 MPa\"\nreal_youngs_modulus_Pa = \"414 GPa\"\npoisson_ratio = 0.23\n"
    "restitution = 0.45\nfriction = 0.4\n";
const std::string general = "[scene]\nend_time_s = 5\n";
const std::string particles = "[particles]\ndiameter_m = \"0.8 mm\"\ntemperature_K = 300\n";
const std::string box = "[box]\nsize_m = [0.010, 0.004, 0.050]\n";
const std::string plug = "[feed]\nkind = 'plug'\nsolid_fraction = 0.25\nmass_flow_kg_s = '1.59 g/s'\n";
const std::string plug_scene = general + material + particles + box + plug;

Scene parse(const std::string& text) {
  auto document = TomlDocument::from_string(text, "f.toml");
  Scene scene = read_scene(document);
  document.finish();
  return scene;
}

std::vector<std::string> problems_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Scene, PlugIsCompleteWithDefaults) {
  const Scene s = parse(plug_scene);
  EXPECT_EQ(s.materials.size(), 1u);
  EXPECT_EQ(s.materials[0].youngs_modulus_Pa, 5e6);
  EXPECT_EQ(s.materials[0].real_youngs_modulus_Pa, 414e9);
  EXPECT_EQ(s.materials[0].emissivity, 1);
  ASSERT_EQ(s.walls.size(), 6u);
  EXPECT_EQ(s.box_wall_count, 6u);
  EXPECT_EQ(s.walls[2].name, "y_min");
  EXPECT_TRUE(s.walls[2].contact);
  EXPECT_FALSE(s.walls[4].contact) << "the ends of a plug channel are open to particles";
  EXPECT_FALSE(s.walls[5].contact);
  EXPECT_EQ(s.walls[0].role, WallRole::adiabatic) << "without radiation no role need be chosen";
  EXPECT_EQ(s.region.max, s.box.max);
  EXPECT_EQ(s.engine, EngineKind::native);
  EXPECT_EQ(s.precision, Precision::full);
  EXPECT_EQ(parse(plug_scene + "[dem]\nprecision = 'mixed'\n").precision, Precision::mixed);
  EXPECT_EQ(s.step_s, 0);
  EXPECT_TRUE(s.feed.start_filled);
  // m = rho phi A v; 0.0399 m/s is the paper's speed for phi = 0.25 at 1.59 g/s.
  EXPECT_NEAR(s.feed.velocity_m_s, 1.59e-3 / (3984 * 0.25 * 0.01 * 0.004), 1e-15);
  EXPECT_NEAR(s.feed.velocity_m_s, 0.0399, 5e-5);
}

TEST(Scene, DerivesTheThirdOfThePlugQuantities) {
  const Scene speed = parse(replaced(plug_scene, "solid_fraction = 0.25", "velocity_m_s = 0.0399"));
  EXPECT_NEAR(speed.feed.solid_fraction, 0.25, 2e-4);
  const Scene flow = parse(replaced(plug_scene, "mass_flow_kg_s = '1.59 g/s'", "velocity_m_s = '4 cm/s'"));
  EXPECT_NEAR(flow.feed.mass_flow_kg_s, 3984 * 0.25 * 4e-5 * 0.04, 1e-15);
  EXPECT_NO_THROW(parse(plug_scene + "velocity_m_s = 0.04\n")) << "all three, consistent within 1 %";
}

TEST(Scene, DerivesAHoppersCountFromItsMass) {
  const std::string hopper =
      "[feed]\nkind = 'hopper'\nmass_kg = '14.5 g'\n[feed.fill_region]\nmin_m = [0, 0, 0.04]\n"
      "max_m = [0.01, 0.004, 0.05]\n";
  const Scene s = parse(general + material + particles + box + hopper);
  EXPECT_EQ(s.feed.particle_count, 13576);  // the paper's 14.5 g
  EXPECT_EQ(s.feed.remove_below_m, 0);
  EXPECT_TRUE(s.feed.refill);
  EXPECT_EQ(s.feed.fill_region.min.z, 0.04);
}

TEST(Scene, WallsTakeWhatTheyAreGiven) {
  const Scene s =
      parse(replaced(plug_scene, "friction = 0.4", "friction = 0.4\nemissivity = 0.7") +
            "[walls.y_min]\nrole = 'isothermal'\ntemperature_K = '727 degC'\nemissivity = 0.5\n"
            "[walls.z_min]\nrole = 'open'\ntemperature_K = 300\n[walls.x_min]\nrole = 'excluded'\n");
  EXPECT_EQ(s.walls[2].role, WallRole::isothermal);
  EXPECT_NEAR(s.walls[2].temperature_K, 1000.15, 1e-9);
  EXPECT_EQ(s.walls[2].emissivity, 0.5);
  EXPECT_EQ(s.walls[3].emissivity, 0.7) << "the material's";
  EXPECT_EQ(s.walls[4].role, WallRole::open);
  EXPECT_EQ(s.walls[4].emissivity, 1);
  EXPECT_EQ(s.walls[0].role, WallRole::excluded);
}

TEST(Scene, ABeltMayHaveRoundedDigits) {
  const auto scene = parse(plug_scene +
                           "[[polygon]]\nname = 'belt'\nvelocity_m_s = [0.866, 0, 0.5]\n"
                           "vertices_m = [[0,0,0],[0.86602540378,0,0.5],[0.86602540378,1,0.5],[0,1,0]]\n");
  EXPECT_EQ(scene.walls.back().velocity_m_s.z, 0.5);
}

TEST(Scene, PeriodicDirectionsHaveNoWalls) {
  const Scene s = parse(replaced(plug_scene, "[box]\n", "[box]\nperiodic = ['x', 'y']\n"));
  EXPECT_EQ(s.walls.size(), 2u);
  EXPECT_EQ(s.walls[0].name, "z_min");
  EXPECT_TRUE(s.periodic[0] && s.periodic[1] && !s.periodic[2]);
}

TEST(Scene, TheBoxIsDerivedFromPolygonsAndMeshes) {
  const TemporaryFolder folder;
  const auto stl =
      folder.write("m.stl",
                   "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 5\nvertex 20 0 5\nvertex 0 4 5\n"
                   "endloop\nendfacet\nendsolid a\n");
  const auto bed = folder.write("bed.csv", "x,y,z,radius\n0.001,0.001,0.001,0.0004\n");
  const Scene s =
      parse(general + material + "[particles]\nfile = '" + bed.string() +
            "'\n[[polygon]]\nname = 'floor'\nvertices_m = [[0,0,0],[0.01,0,0],[0,0.004,0]]\nopens_at_s = 2\n"
            "[[mesh]]\nname = 'lid'\nscale = 0.001\nfile = '" +
            stl.string() + "'\nflip = true\n");
  ASSERT_EQ(s.walls.size(), 2u);
  EXPECT_EQ(s.box_wall_count, 0u);
  EXPECT_EQ(s.walls[0].opens_at_s, 2);
  EXPECT_EQ(s.walls[1].name, "lid");
  EXPECT_NEAR(area(s.walls[1]), 0.5 * 0.02 * 0.004, 1e-10);
  EXPECT_NEAR(s.box.max.x, 0.02, 1e-8);
  EXPECT_NEAR(s.box.max.z, 0.005, 1e-8);
  EXPECT_NEAR(s.particle_diameter_m, 0.0008, 1e-15) << "from the file";
  const auto& t = s.walls[1].triangles[0];
  const auto& v = s.walls[1].vertices;
  EXPECT_LT(cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]).z, 0) << "flipped";
}

TEST(Scene, SolidsOfOneFileHaveRolesOfTheirOwn) {
  const TemporaryFolder folder;
  const auto facet = [](const char* name, double z) {
    return fmt::format(
        "solid {0}\nfacet normal 0 0 1\nouter loop\nvertex 0 0 {1}\nvertex 2 0 {1}\nvertex 0 4 {1}\nendloop\n"
        "endfacet\nendsolid {0}\n",
        name, z);
  };
  const auto stl = folder.write("m.stl", facet("heater", 0) + facet("lid", 1) + facet("side", 2));
  const auto bed = folder.write("bed.csv", "x,y,z,radius\n0.001,0.001,0.001,0.0004\n");
  const std::string text = general + material + "[particles]\nfile = '" + bed.string() +
                           "'\n[[mesh]]\nname = 'tank'\nfile = '" + stl.string() +
                           "'\nrole = 'adiabatic'\nemissivity = 0.6\n";
  const Scene s = parse(text +
                        "[mesh.solid.heater]\nrole = 'isothermal'\ntemperature_K = 900\nemissivity = 0.3\n"
                        "[mesh.solid.lid]\nrole = 'open'\ntemperature_K = 310\n");
  ASSERT_EQ(s.walls.size(), 3u);
  EXPECT_EQ(s.walls[0].name, "tank.heater");
  EXPECT_EQ(s.walls[0].role, WallRole::isothermal);
  EXPECT_EQ(s.walls[0].temperature_K, 900);
  EXPECT_EQ(s.walls[0].emissivity, 0.3);
  EXPECT_EQ(s.walls[1].role, WallRole::open);
  EXPECT_EQ(s.walls[1].temperature_K, 310);
  EXPECT_EQ(s.walls[1].emissivity, 1) << "an opening is black";
  EXPECT_EQ(s.walls[2].role, WallRole::adiabatic);
  EXPECT_EQ(s.walls[2].emissivity, 0.6) << "that of the mesh";

  const auto typo = problems_of(text + "[mesh.solid.heatre]\nrole = 'isothermal'\ntemperature_K = 900\n");
  ASSERT_EQ(typo.size(), 1u);
  EXPECT_NE(typo[0].find("heatre"), std::string::npos) << typo[0];
  EXPECT_NE(typo[0].find("heater"), std::string::npos) << "suggests: " << typo[0];
  EXPECT_EQ(problems_of(text + "[mesh.solid.heater]\nrole = 'isothermal'\n").size(), 1u) << "no temperature";
}

TEST(Scene, ShippedMaterialsAreThePapers) {
  for (const char* name : {"alumina", "mustard_seed"}) {
    const std::string file = granrad::source_dir() + "/data/materials/" + name + ".toml";
    const Scene s =
        parse(general + "[material]\nfile = '" + file + "'\nfriction = 0.3\n" + particles + box + plug);
    const Material& m = s.materials[0];
    EXPECT_EQ(m.name, name);
    EXPECT_EQ(m.friction, 0.3) << "keys of the scene win";
    EXPECT_EQ(m.real_youngs_modulus_Pa, 414e9);
    // The paper's diffusivities, rounded to two digits there: k / (rho c).
    const double diffusivity = m.conductivity_W_mK / (m.density_kg_m3 * m.specific_heat_J_kgK);
    EXPECT_NEAR(diffusivity, m.name == "alumina" ? 1.1e-5 : 1.08e-7, m.name == "alumina" ? 5e-7 : 5e-10);
  }
}

struct BadScene {
  std::string text;
  std::vector<std::string> expected;  // fragments, one per problem, in order
};

TEST(Scene, BadScenesAreRefusedWithTheirPlace) {
  const std::string radiation = "[radiation]\nsource = 'paths'\n";
  const std::string missing_role = ": missing: radiation is on, so every wall must choose";
  const std::string polygon_scene = plug_scene + "[[polygon]]\nname = 'p'\n";
  const std::string hopper_scene = general + material + particles + box + "[feed]\nkind = 'hopper'\n";
  const std::string fill = "[feed.fill_region]\nmin_m = [0,0,0]\nmax_m = [0.01,0.004,0.01]\n";
  const std::vector<BadScene> table{
      {replaced(plug_scene, "end_time_s = 5", ""),
       {"f.toml:1:1: scene.end_time_s is missing: a number > 0 s"}},
      {replaced(plug_scene, "end_time_s = 5", "end_time_s = 0"),
       {"f.toml:2:14: scene.end_time_s = 0 (must be > 0 s)"}},
      {replaced(plug_scene, "end_time_s = 5", "end_tim_s = 5"),
       {"f.toml:1:1: scene.end_time_s is missing",
        "f.toml:2:1: unknown key 'end_tim_s' in [scene]. Did you mean 'end_time_s'?"}},
      {replaced(plug_scene, "end_time_s = 5", "end_time_s = 5\ngravity_m_s2 = [0, 0, -9.81]"),
       {"f.toml:3:16: scene.gravity_m_s2: must be zero with [feed] kind = \"plug\""}},
      {general + particles + box + plug,
       {"f.toml: [material] is missing; it needs density_kg_m3, specific_heat_J_kgK"}},
      {replaced(plug_scene, "poisson_ratio = 0.23", "poisson_ratio = 0.5"),
       {"f.toml:9:17: material.poisson_ratio = 0.5 (must be in [0, 0.5): 0.5 is incompressible)"}},
      {replaced(plug_scene, "restitution = 0.45", "restitution = 0"),
       {"f.toml:10:15: material.restitution = 0 (must be in (0, 1]: part of the normal speed kept in a "
        "collision)"}},
      {replaced(plug_scene, "friction = 0.4", "friction = -0.4"),
       {"f.toml:11:12: material.friction = -0.4 (must be >= 0)"}},
      {replaced(plug_scene, "density_kg_m3 = 3984", "density_kg_m3 = '3984 mm'"),
       {"f.toml:4:17: material.density_kg_m3 = \"3984 mm\" ('mm' cannot be converted to kg/m3)"}},
      {replaced(plug_scene, "friction = 0.4", "friction = 0.4\nemissivity = 1.4"),
       {"f.toml:12:14: material.emissivity = 1.4 (must be in [0, 1]: grey diffuse surface)"}},
      {replaced(plug_scene, "diameter_m = \"0.8 mm\"\n", ""),
       {"f.toml:12:1: particles.diameter_m is missing: a number > 0 m"}},
      {replaced(plug_scene, "temperature_K = 300", "temperature_K = 0"),
       {"f.toml:14:17: particles.temperature_K = 0 (must be > 0 K)"}},
      {replaced(plug_scene, "[particles]", "[particles]\nfile = 'none.csv'"),
       {"particles.file = \"none.csv\" (no such file: "}},
      {general + material + particles + box,
       {"particles: there are no particles: give [particles] file or a [feed]"}},
      {general + material + particles + plug,
       {"box: missing: give [box] size_m, or walls by [[polygon]] or [[mesh]]"}},
      {replaced(plug_scene, "0.004, 0.050", "-0.004, 0.050"),
       {"f.toml:16:18: box.size_m[1] = -0.004 (must be > 0 m)"}},
      {replaced(plug_scene, "[box]", "[box]\nperiodic = ['w']"),
       {"box.periodic: knows \"x\", \"y\" and \"z\", not \"w\""}},
      {replaced(plug_scene, "[box]", "[box]\nperiodic = ['x']") + "[walls.x_min]\nrole = 'adiabatic'\n",
       {"walls.x_min: this wall does not exist: the box is periodic across it"}},
      {replaced(plug_scene, "[box]", "[box]\nwalls = false") + "[walls.z_max]\nrole = 'adiabatic'\n",
       {"walls.z_max: this wall does not exist: the box has no walls"}},
      {plug_scene + radiation,
       {"walls.x_min.role" + missing_role, "walls.x_max.role" + missing_role,
        "walls.y_min.role" + missing_role, "walls.y_max.role" + missing_role,
        "walls.z_min.role" + missing_role, "walls.z_max.role" + missing_role}},
      {plug_scene + "[walls.x_min]\nrole = 'isothermal'\n",
       {"f.toml:21:1: walls.x_min.temperature_K is missing: a number > 0 K"}},
      {plug_scene + "[walls.x_min]\nrole = 'isotermal'\n",
       {"f.toml:22:8: walls.x_min.role = \"isotermal\" (must be one of \"isothermal\", \"adiabatic\", "
        "\"open\", \"excluded\"). "
        "Did you mean \"isothermal\"?"}},
      {plug_scene + "[walls.x_min]\nrole = 'adiabatic'\ntemperature_K = 300\n",
       {"walls.x_min.temperature_K = 300 (an adiabatic wall has no temperature of its own"}},
      {plug_scene + "[walls.x_min]\nrole = 'open'\ntemperature_K = 300\nemissivity = 0.5\n",
       {"walls.x_min.emissivity = 0.5 (an open wall is the black surroundings"}},
      {plug_scene + "[walls.left]\nrole = 'open'\n", {"f.toml:21:8: unknown table [walls.left]"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0]]\n",
       {"polygon[0].vertices_m: must be a list of at least 3 points"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0],[1,1,0],[0,1,0.1]]\n",
       {"the corners must lie in one plane"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0],[0.2,0.2,0],[0,1,0]]\n",
       {"the polygon must be convex; split it"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0],[2,0,0]]\n",
       {"the polygon has no area, or crosses itself"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,1,0],[1,0,0],[0,1,0]]\n",
       {"the polygon has no area, or crosses itself"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0],[1,0,0],[0,1,0]]\n", {"corners 1 and 2 coincide"}},
      {replaced(polygon_scene, "'p'", "'x_min'") + "vertices_m = [[0,0,0.01],[1,0,0.01],[0,1,0.01]]\n",
       {"polygon[0].name = \"x_min\" (another wall is called x_min; names must differ)"}},
      {plug_scene + "[[mesh]]\nname = 'm'\nfile = 'none.stl'\n",
       {"mesh[0].file = \"none.stl\" (no such file: "}},
      {plug_scene + "[polygon]\nname = 'p'\n", {"polygon: must be written as [[polygon]]"}},
      {plug_scene + "[region]\nmin_m = [0,0,0.04]\nmax_m = [0.01,0.004,0.01]\n",
       {"region.max_m: must be above min_m in every direction"}},
      {plug_scene + "[region]\nmin_m = [0,0,-1]\n", {"region: the region must lie inside the box"}},
      {replaced(plug_scene, "solid_fraction = 0.25", "solid_fraction = 0.8"),
       {"f.toml:19:18: feed.solid_fraction = 0.8 (must be in (0, 0.64): spheres cannot be packed denser at "
        "random)"}},
      {replaced(plug_scene, "solid_fraction = 0.25\n", ""),
       {"feed: a plug needs two of solid_fraction, mass_flow_kg_s and velocity_m_s"}},
      {plug_scene + "velocity_m_s = 0.05\n",
       {"feed.mass_flow_kg_s = \"1.59 g/s\" (solid_fraction and velocity_m_s give 0.001992 kg/s"}},
      {replaced(plug_scene, "solid_fraction = 0.25", "velocity_m_s = 0.001"),
       {"needs a solid fraction of 9.98 at this speed"}},
      {replaced(plug_scene, "kind = 'plug'", "kind = 'plugg'"),
       {"feed.kind = \"plugg\" (must be one of \"plug\", \"hopper\"). Did you mean \"plug\"?"}},
      {plug_scene + "particle_count = 5\n", {"f.toml:21:1: unknown key 'particle_count' in [feed]"}},
      {hopper_scene + fill, {"feed.particle_count is missing: an integer in [1, 2147483647]"}},
      {hopper_scene + "particle_count = 10\nmass_kg = '14.5 g'\n" + fill, {"mass_kg gives 13576 particles"}},
      {hopper_scene + "particle_count = 10\n", {"[feed.fill_region] is missing; it needs min_m, max_m"}},
      {replaced(hopper_scene + "particle_count = 10\n" + fill, "max_m = [0.01,", "max_m = [0.0005,"),
       {"the fill region must hold a particle"}},
      {plug_scene + "[dem]\nprecision = 'single'\n",
       {"dem.precision = \"single\" (must be one of \"double\", \"mixed\")"}},
      {plug_scene + "[dem]\nstep_s = 0\n", {"dem.step_s = 0 (must be > 0 s)"}},
      {plug_scene + "[walls.y_min]\nvelocity_m_s = [0, 0.1, 0.2]\n",
       {"walls.y_min.velocity_m_s: 0.1 m/s of it point across the surface of wall y_min"}},
      {polygon_scene + "vertices_m = [[0,0,0],[1,0,0],[1,0,1]]\nvelocity_m_s = [1, 0.01, 1]\n",
       {"0.01 m/s of it point across the surface of wall p"}},
      {plug_scene + "[dme]\nstep_s = 1\n", {"f.toml:21:2: unknown table [dme]. Did you mean [dem]?"}},
      {plug_scene + "[[materials]]\nname = 'material'\n" + material.substr(11),
       {"materials[0].name = \"material\" (another material has this name"}},
  };
  for (const auto& [text, expected] : table) {
    const auto problems = problems_of(text);
    EXPECT_EQ(problems.size(), expected.size()) << text;
    for (std::size_t k = 0; k < std::min(problems.size(), expected.size()); ++k)
      EXPECT_NE(problems[k].find(expected[k]), std::string::npos)
          << "got  " << problems[k] << "\nwant " << expected[k];
  }
  EXPECT_GE(table.size(), 25u);
}

Scene scene_from_file(const fs::path& file, const std::string& more = "") {
  return parse(general + material + "[particles]\ntemperature_K = 350\nfile = '" + file.string() + "'\n" +
               more + box);
}

TEST(InitialBed, TakesParticlesFromAFileSortedById) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("bed.csv", "id,x,y,z,radius\n7,0.002,0.002,0.01,0.0004\n3,0.004,0.002,0.01,0.0003\n");
  const Bed bed = initial_bed(scene_from_file(file));
  EXPECT_EQ(bed.id, (std::vector<std::int64_t>{3, 7}));
  EXPECT_EQ(bed.radius_m, (std::vector<double>{0.0003, 0.0004}));
  EXPECT_EQ(bed.temperature_K, (std::vector<double>{350, 350})) << "the file has none";
  EXPECT_EQ(bed.next_id, 8);
  EXPECT_EQ(bed.walls.size(), 6u);
  EXPECT_EQ(bed.materials.size(), 1u);
}

// Planted: the plane of a face taken as endless: what stands in a hopper above the channel is refused.
TEST(InitialBed, AFaceBoundsOnlyAsFarAsItGoesBesideOtherWalls) {
  const TemporaryFolder folder;
  const std::string hopper =
      "[walls.z_max]\ncontact = false\n[[polygon]]\nname = \"hopper\"\nrole = \"adiabatic\"\n"
      "vertices_m = [[0.03, 0, 0.06], [0.03, 0.004, 0.06], [0.01, 0.004, 0.05], [0.01, 0, 0.05]]\n";
  const auto above = folder.write("above.csv", "x,y,z,radius\n0.012,0.002,0.055,0.0004\n");
  EXPECT_NO_THROW(initial_bed(scene_from_file(above, hopper))) << "wider than the channel below it";
  const auto beside = folder.write("beside.csv", "x,y,z,radius\n0.012,0.002,0.02,0.0004\n");
  EXPECT_THROW(initial_bed(scene_from_file(beside, hopper)), InputError);
}

TEST(InitialBed, RefusesParticlesOutsideTheWallsAndDeepOverlaps) {
  const TemporaryFolder folder;
  std::string rows = "x,y,z,radius\n";
  for (int k = 0; k < 12; ++k) rows += "0.011,0.002," + std::to_string(0.002 + 0.002 * k) + ",0.0004\n";
  try {
    initial_bed(scene_from_file(folder.write("outside.csv", rows)));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("12 particles lie outside the walls of the box, ids 1, 2, 3, 4, 5, 6, 7, 8, "
                        "9, 10, ..."),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(
      initial_bed(scene_from_file(folder.write("outside.csv", rows), "[walls.x_max]\ncontact = false\n")));

  const std::string first = "x,y,z,radius\n0.002,0.002,0.01,0.0004\n";
  EXPECT_NO_THROW(
      initial_bed(scene_from_file(folder.write("ok.csv", first + "0.00277,0.002,0.01,0.0004\n"))));
  try {
    initial_bed(scene_from_file(folder.write("deep.csv", first + "0.00275,0.002,0.01,0.0004\n")));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1 pairs overlap by more than a tenth of a radius, ids 1-2"),
              std::string::npos)
        << error.what();
  }
  // Planted, seen: pairs alone looked at (the run goes on, the sphere leaves the wall).
  const auto cut = folder.write("cut.csv", "x,y,z,radius\n0.0003,0.002,0.01,0.0004\n");
  try {
    initial_bed(scene_from_file(cut));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("1 particles and walls overlap by more than a tenth of a radius, ids 1 with"),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(initial_bed(scene_from_file(cut, "[dem]\nengine = \"none\"\n")));
}

TEST(InitialBed, AFrameBringsItsStateAndItsContacts) {
  const TemporaryFolder folder;
  const auto csv =
      folder.write("bed.csv", "x,y,z,radius\n0.002,0.002,0.01,0.0004\n0.0027999,0.002,0.01,0.0004\n");
  Bed saved = initial_bed(scene_from_file(csv));
  saved.velocity_m_s[1] = {0.1, 0.2, 0.3};
  saved.temperature_K[0] = 512;
  saved.time_s = 3;
  saved.step = 300;
  saved.contacts = {{1, -4, {1e-7, 0, 0}}, {1, 2, {0, 1e-7, 0}}};
  const fs::path frame = folder.write("frame.hdf", "");
  write_frame(frame, saved, {});
  const Bed same = initial_bed(scene_from_file(frame));
  EXPECT_EQ(same.velocity_m_s, saved.velocity_m_s);
  EXPECT_EQ(same.temperature_K, saved.temperature_K);
  EXPECT_EQ(same.contacts.size(), 2u);
  EXPECT_EQ(same.time_s, 0) << "a new run begins";
  EXPECT_EQ(same.step, 0);
  const Bed other_walls = initial_bed(scene_from_file(frame,
                                                      "[[polygon]]\nname = 'p'\nvertices_m = "
                                                      "[[0,0,0],[0.01,0,0],[0,0.004,0]]\n"));
  ASSERT_EQ(other_walls.contacts.size(), 1u) << "memory of walls that are not there is dropped";
  EXPECT_EQ(other_walls.contacts[0].second, 2);
}

}  // namespace
}  // namespace granrad
