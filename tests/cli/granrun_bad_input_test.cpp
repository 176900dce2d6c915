// Requirement: whatever is wrong in what the user wrote, granrun says where and what, exits with 2 (3: cannot
// be read) and writes nothing.
#include "granrun.h"
#include "tests/source_dir.h"

using namespace granrad::cli;

namespace {

struct BadScene {
  const char* what;
  const char* from;  ///< text of small_plug ...
  const char* to;    ///< ... and what stands there instead
  const char* message;
  int code = 2;
};

const BadScene bad_scenes[] = {
    {"syntax", "[gas]", "[gas", "bad.toml:"},
    {"unknown key", "every_s = 0.002", "evry_s = 0.002", "every_s"},
    {"unknown table", "[gas]", "[gaz]", "gaz"},
    {"unknown wall", "[walls.y_max]", "[walls.y_mac]", "y_m"},
    {"missing density", "density_kg_m3 = 3984", "", "density_kg_m3"},
    {"negative density", "density_kg_m3 = 3984", "density_kg_m3 = -1", "density_kg_m3"},
    {"poisson ratio 2", "poisson_ratio = 0.23", "poisson_ratio = 2.0", "poisson_ratio"},
    {"restitution 0", "restitution = 0.45", "restitution = 0", "restitution"},
    {"negative friction", "friction = 0.4", "friction = -0.4", "friction"},
    {"a text for a number", "friction = 0.4", "friction = \"rough\"", "friction"},
    {"emissivity above 1", "friction = 0.4", "friction = 0.4\nemissivity = 1.4", "emissivity"},
    {"diameter in seconds", "\"0.8 mm\"", "\"0.8 s\"", "diameter_m"},
    {"diameter in no unit", "\"0.8 mm\"", "\"0.8 furlongz\"", "diameter_m"},
    {"temperature 0", "temperature_K = 300", "temperature_K = 0", "temperature_K"},
    {"flat box", "size_m = [0.004, 0.003, 0.006]", "size_m = [0.004, 0, 0.006]", "size_m"},
    {"box of two numbers", "size_m = [0.004, 0.003, 0.006]", "size_m = [0.004, 0.003]", "size_m"},
    {"wall role", "role = \"isothermal\"", "role = \"hot\"", "isothermal"},
    {"feed kind", "kind = \"plug\"", "kind = \"plugg\"", "plug"},
    {"solid fraction 0.9", "solid_fraction = 0.25", "solid_fraction = 0.9", "solid_fraction"},
    {"plug without speed", "velocity_m_s = 0.1\n", "\n", "velocity_m_s"},
    {"engine", "step_s = 1e-5", "engine = \"nativ\"", "native"},
    {"step beyond Rayleigh", "step_s = 1e-5", "step_s = 1e-4", "largest allowed value is 1.8"},
    {"negative step", "step_s = 1e-5", "step_s = -1e-5", "step_s"},
    {"radiation source", "source = \"paths\"", "source = \"photons\"", "correlation"},
    {"correlation without table", "source = \"paths\"", "source = \"correlation\"", "table"},
    {"table not there", "source = \"paths\"\nrays = 500", "source = \"correlation\"\ntable = \"none.toml\"",
     "none.toml"},
    {"table for paths", "rays = 500", "table = \"bad.toml\"", "table"},
    {"closure for paths", "rays = 500", "closure = \"row_sum\"", "closure"},
    {"order for paths", "rays = 500", "order = 2", "order"},
    {"too few walks", "rays = 500", "rays = 3", "rays"},
    {"output not on radiation steps", "every_s = 0.004", "every_s = 0.0040055", "output.every_s"},
    {"heat steps that do not fit", "[radiation]", "[conduction]\nevery_steps = 70\n[radiation]",
     "every_steps"},
    {"lens smaller than the particle", "[gas]", "[gas]\nlens_radius_ratio = 0.9", "lens_radius_ratio"},
    {"no gap", "[gas]", "[gas]\nminimum_gap_m = 0", "minimum_gap_m"},
    {"conduction switch", "[gas]", "[conduction]\nsolid = 1\n[gas]", "solid"},
    {"excluded wall with paths", "[walls.z_max]\nrole = \"adiabatic\"", "[walls.z_max]\nrole = \"excluded\"",
     "z_max"},
    {"frozen bed with DEM interval", "step_s = 1e-5", "engine = \"none\"\n[conduction]\nevery_steps = 10",
     "every_steps"},
    {"end before the begin", "end_time_s = 0.04", "end_time_s = -1", "end_time_s"},
    {"particles not there", "temperature_K = 300\n", "temperature_K = 300\nfile = \"none.csv\"\n",
     "none.csv"},
};

}  // namespace

TEST(GranrunBadInput, EveryBadSceneIsRefusedWithItsMessage) {
  Scratch scratch;
  for (const auto& bad : bad_scenes) {
    const auto scene = scratch.write("bad.toml", edited(small_plug, bad.from, bad.to));
    const auto folder = scratch.root / "case";
    for (const std::string& arguments :
         {"check " + scene.string(), "run " + scene.string() + " -o " + folder.string()}) {
      const auto outcome = granrun(scratch, arguments);
      EXPECT_EQ(outcome.code, bad.code) << bad.what << "\n" << outcome.err;
      EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << bad.what << "\n" << outcome.err;
    }
    EXPECT_FALSE(fs::exists(folder)) << bad.what;
  }
}

TEST(GranrunBadInput, AllMistakesAreListedAtOnceWithTheirPlaces) {
  Scratch scratch;
  auto text = edited(small_plug, "poisson_ratio = 0.23", "poisson_ratio = 2.0");
  text = edited(text, "rays = 500", "rais = 500");
  text = edited(text, "solid_fraction = 0.25", "solid_fraction = 0.9");
  const auto outcome = granrun(scratch, "check " + scratch.write("bad.toml", text).string());
  EXPECT_EQ(outcome.code, 2);
  for (const char* message :
       {"bad.toml:10:", "poisson_ratio", "solid_fraction", "unknown key", "Did you mean 'rays'"})
    EXPECT_NE(outcome.err.find(message), std::string::npos) << message << "\n" << outcome.err;
}

TEST(GranrunBadInput, OverridesAreCheckedLikeTheFile) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  for (const char* set : {"radiation.rais=3", "material.friction=-1", "nonsense", "radiation.rays=many"}) {
    const auto outcome = granrun(scratch, "check " + scene + " --set " + set);
    EXPECT_EQ(outcome.code, 2) << set << "\n" << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << set;
  }
}

TEST(GranrunBadInput, BadParticleFilesAreRefused) {
  Scratch scratch;
  const auto text =
      edited(edited(small_plug, "step_s = 1e-5", "engine = \"none\""),
             "[feed]\nkind = \"plug\"\n"
             "solid_fraction = 0.25\nvelocity_m_s = 0.1\ntransverse_velocity_std_m_s = 0.02\nseed = 3\n",
             "");
  struct Bad {
    const char *name, *particles, *message;
  };
  const Bad all[] = {
      {"a.csv", "x,y,radius\n0.001,0.001,4e-4\n", "a.csv"},
      {"b.csv", "x,y,z,radius\n0.001,0.001,nan,4e-4\n", "b.csv:2"},
      {"c.csv", "x,y,z,radius\n0.001,0.001,0.001,-4e-4\n", "c.csv:2"},
      {"d.csv", "x,y,z,radius\n0.001,0.001,4e-4\n", "d.csv:2"},
      {"e.csv", "x,y,z,radius\n0.001,0.001,here,4e-4\n", "e.csv:2"},
      {"g.dump",
       "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
       "ITEM: ATOMS id x y z radius\n1 0.001 0.001 0.001 4e-4\n",
       "g.dump"},
      {"h.dump",
       "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
       "ITEM: ATOMS id x y radius\n1 0.001 0.001 4e-4\n",
       "h.dump"},
      {"i.csv", "x,y,z,radius\n0.1,0.001,0.001,4e-4\n", "outside"},
      {"j.hdf", "not HDF5", "j.hdf"},
  };
  for (const auto& bad : all) {
    scratch.write(bad.name, bad.particles);
    const auto scene =
        scratch.write("bed.toml", edited(text, "temperature_K = 300\n",
                                         std::string("temperature_K = 300\nfile = \"") + bad.name + "\"\n"));
    const auto outcome =
        granrun(scratch, "run " + scene.string() + " -o " + (scratch.root / "case").string());
    EXPECT_TRUE(outcome.code == 2 || (outcome.code == 3 && std::string(bad.name) == "j.hdf"))
        << bad.name << " " << outcome.code << "\n"
        << outcome.err;
    EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << bad.name << "\n" << outcome.err;
    EXPECT_FALSE(fs::exists(scratch.root / "case")) << bad.name;
    fs::remove_all(scratch.root / "case");
  }
}

TEST(GranrunBadInput, AMissingParticleFileIsOneMistake) {
  Scratch scratch;
  const auto scene =
      scratch.write("plug.toml", edited(small_plug, "diameter_m = \"0.8 mm\"", "file = \"none.csv\""))
          .string();
  const auto outcome = granrun(scratch, "check " + scene);
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("none.csv"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("diameter_m"), std::string::npos) << outcome.err;
}

TEST(GranrunBadInput, BadTablesAreRefused) {
  Scratch scratch;
  const std::string good =
      content(fs::path(granrad::source_dir()) / "data/correlations/li_2024_printed.toml");
  const auto scene = scratch
                         .write("plug.toml", edited(small_plug, "source = \"paths\"\nrays = 500",
                                                    "source = \"correlation\"\ntable = \"table.toml\""))
                         .string();
  scratch.write("table.toml", good);
  ASSERT_EQ(granrun(scratch, "check " + scene).code, 0) << granrun(scratch, "check " + scene).err;
  EXPECT_EQ(granrun(scratch, "check " + scene + " --set feed.solid_fraction=0.55").code, 2)
      << "beyond the table";
  for (const auto& [from, to] :
       {std::pair{"form", "from"}, {"\"cubic\"", "\"quartic\""}, {"version = 1", "version = 99"}}) {
    scratch.write("table.toml", edited(good, from, to));
    const auto outcome = granrun(scratch, "check " + scene);
    EXPECT_EQ(outcome.code, 2) << to << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find("table.toml"), std::string::npos) << outcome.err;
  }
}
