// Requirement: granrun answers --help and --version, and refuses wrong usage with exit code 2 and a message
// that helps.
#include "granrun.h"

using namespace granrad::cli;

TEST(GranrunUsage, HelpAndVersionSucceed) {
  Scratch scratch;
  const auto help = granrun(scratch, "--help");
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"run", "check", "validate", "sweep", "report", "export", "75"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  const auto version = granrun(scratch, "--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("granrun ", 0), 0u);
  EXPECT_EQ(granrun(scratch, "run --help").code, 0);
}

TEST(GranrunUsage, WrongUsageIsExitCode2) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  for (const std::string& arguments :
       {std::string(""), std::string("simulate"), std::string("run"), "run " + scene, std::string("run -o x"),
        "run " + scene + " -o x --unknown", "check " + scene + " --threads 0",
        "check " + scene + " --threads many", "check " + scene + " -q -v",
        "run " + scene + " -o x --walltime 10", "run " + scene + " -o x --walltime 00:61:00",
        "export " + scratch.root.string() + " --to png", "report " + scratch.root.string(),
        "export " + scratch.root.string() + " --to vtp"}) {
    const auto outcome = granrun(scratch, arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_FALSE(outcome.out.empty() && outcome.err.empty()) << arguments;
  }
}

TEST(GranrunUsage, MissingFilesAreExitCode3) {
  Scratch scratch;
  EXPECT_EQ(granrun(scratch, "check " + (scratch.root / "none.toml").string()).code, 3);
}

TEST(GranrunUsage, CheckSaysWhatIsModelledAndWhatIsNotAndWritesNothing) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto all = granrun(scratch, "check " + scene);
  ASSERT_EQ(all.code, 0) << all.err;
  for (const char* text :
       {"gas lenses", "paths, 500 walks", "left out", "gravity", "Rayleigh time", "Hertz time", "DEM step",
        "radiation update", "conduction allows", "walls isothermal: y_min, y_max"})
    EXPECT_NE(all.out.find(text), std::string::npos) << text << "\n" << all.out;
  const auto less =
      granrun(scratch, "check " + scene + " --set radiation.source=none --set conduction.solid=false");
  ASSERT_EQ(less.code, 0) << less.err;
  EXPECT_NE(less.out.find("no enclosure is built"), std::string::npos);
  EXPECT_NE(less.out.find("conduction.solid = false"), std::string::npos);
}

// Planted, seen to fail: errors and means of the mass flow printed in kg/s beside the scene's g/s.
TEST(GranrunUsage, PrintsInTheUnitsOfTheScene) {
  Scratch scratch;
  const auto scene = scratch.write(
      "plug.toml", edited(edited(small_plug, "velocity_m_s = 0.1\n", "mass_flow_kg_s = '1.2 g/s'\n"),
                          "temperature_K = 300", "temperature_K = '27 degC'"));
  const auto run = granrun(scratch, "run " + scene.string() + " -o " + (scratch.root / "out").string());
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* text : {" g/s\n", "degC in the region\n", "heat from y_min (726.85 degC)"})
    EXPECT_NE(run.out.find(text), std::string::npos) << text << "\n" << run.out;
  EXPECT_EQ(run.out.find("kg/s"), std::string::npos) << run.out;
}

TEST(GranrunUsage, CheckNamesWallsThatHaveOneRadiosity) {
  Scratch scratch;
  scratch.write("bed.csv", "x,y,z,radius\n0.002,0.002,0.002,0.0005\n");
  const std::string rest =
      "[dem]\nengine = \"none\"\n[particles]\nfile = \"bed.csv\"\n[radiation]\nsource = \"embree\"\n"
      "rays = 100\nevery_s = 0.1\n[output]\nevery_s = 0.1\n";
  const auto checked = [&](const std::string& periodic, const std::string& more) {
    std::string walls;
    for (const std::string face : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
      if (periodic.empty() || face[0] != 'x') walls += "[walls." + face + "]\nrole = \"adiabatic\"\n";
    const auto scene =
        scratch.write("walls.toml", "[scene]\nend_time_s = 1\n" + std::string(granrad::scene_text::alumina) +
                                        "[box]\nsize_m = [0.004, 0.004, 0.004]\n" + periodic + walls + rest);
    const auto outcome = granrun(scratch, "check " + scene.string() + more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out.find("one radiosity for all of each wall that reflects, y_min, y_max, z_min, z_max") !=
           std::string::npos;
  };
  EXPECT_FALSE(checked("", ""));
  EXPECT_TRUE(checked("periodic = [\"x\"]\n", ""));
  EXPECT_FALSE(checked("periodic = [\"x\"]\n", " --set radiation.source=paths"));
  EXPECT_FALSE(checked("periodic = [\"x\"]\n", " --set radiation.wall_patches=whole")) << "as was asked";
}
