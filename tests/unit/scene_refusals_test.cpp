// A scene that is wrong is refused with every problem at its place.
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

}  // namespace
}  // namespace granrad
