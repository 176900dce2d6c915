// A scene is complete and derived where it can be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"
#include "tests/source_dir.h"
#include "tests/temporary_folder.h"
#include "tests/unit/plug_scene.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;
using namespace plug_scene_text;

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

TEST(Scene, AWallMayFollowACourseOfTemperatures) {
  const auto with = [](const std::string& keys) {
    return plug_scene + "[walls.y_min]\nrole = 'isothermal'\n" + keys;
  };
  const Scene s = parse(with("times_s = [0, '1 min']\ntemperatures_K = ['26.85 degC', 900]\n"));
  const Wall& wall = s.walls[2];
  EXPECT_NEAR(wall.temperature_K, 300, 1e-9);
  EXPECT_NEAR(wall.course.at(30), 600, 1e-9);
  for (const std::string keys :
       {"times_s = [0, 1]\ntemperatures_K = [300]\n", "times_s = [0, 1]\n", "temperatures_K = [300, 400]\n",
        "times_s = []\ntemperatures_K = []\n", "times_s = [1, 1]\ntemperatures_K = [300, 400]\n",
        "times_s = [2, 1]\ntemperatures_K = [300, 400]\n", "times_s = [0, 1]\ntemperatures_K = [0, 400]\n",
        "temperature_K = 300\ntimes_s = [0, 1]\ntemperatures_K = [300, 400]\n"})
    EXPECT_EQ(problems_of(with(keys)).size(), 1u) << keys;
  for (const std::string role : {"adiabatic", "open"})
    EXPECT_GE(
        problems_of(replaced(with("times_s = [0, 1]\ntemperatures_K = [300, 400]\n"), "isothermal", role))
            .size(),
        1u)
        << role;
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

}  // namespace
}  // namespace granrad
