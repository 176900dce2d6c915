// What a user types at vfgen and sees: options, files, messages and exit codes.
#include "tests/cli/vfgen_fixture.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/base/files/hdf5_file.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/source_dir.h"

namespace granrad::vfgen_test {
namespace {

const std::string source_dir = granrad::source_dir();

TEST_F(Vfgen, ExplainsItself) {
  expect_says(vfgen("--help"), 0, "trace");
  expect_says(vfgen("trace --help"), 0, "--box");
  expect_says(vfgen("fit --help"), 0, "--form");
  expect_says(vfgen("--version"), 0, "vfgen 0.2.0");
}

std::string dump_snapshot(int step, double z) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) +
         "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z radius\n1 0.5 0.5 " +
         std::to_string(z) + " 0.1\n";
}

TEST_F(Vfgen, TracesTheSnapshotsThatAreChosen) {
  const auto dump =
      write("three.dump", dump_snapshot(10, 0.2) + dump_snapshot(20, 0.4) + dump_snapshot(30, 0.6));
  const auto traced_z = [&](const std::string& file) {
    return granrad::read_view_factors(path(file)).enclosure.centre_m[0].z;
  };
  const std::string trace = "trace " + dump + " --box 1,1,1 --rays 10 -q -o ";
  EXPECT_EQ(vfgen(trace + path("last.h5")).code, 0);
  EXPECT_EQ(traced_z("last.h5"), 0.6);
  EXPECT_EQ(vfgen(trace + path("first.h5") + " --step first").code, 0);
  EXPECT_EQ(traced_z("first.h5"), 0.2);
  EXPECT_EQ(vfgen(trace + path("all.h5") + " --step all").code, 0);
  EXPECT_EQ(traced_z("all_0002.h5"), 0.4);
  expect_says(vfgen(trace + path("x.h5") + " --step 15"), 2, "holds no step 15; there are 10, 20, 30");
  expect_says(vfgen(trace + path("x.h5") + " --step some"), 2, "try first, last or all");
  expect_says(vfgen(trace + path("x.h5") + " --radius 0.2"), 2, "has radii of its own; drop --radius");
  const auto cut = write("cut.dump", dump_snapshot(10, 0.2) + dump_snapshot(20, 0.4).substr(0, 90));
  expect_says(vfgen("trace " + cut + " --box 1,1,1 --rays 10 -o " + path("x.h5")), 0,
              "the last snapshot is not whole");
}

TEST_F(Vfgen, RefusesBadUsageWithCode2) {
  const auto csv = two_spheres();
  expect_says(vfgen(""), 2, "subcommand");
  expect_says(vfgen("tracee x"), 2, "subcommand");
  expect_says(vfgen("trace " + csv), 2, "--output");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --method rays"), 2, "embree");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --rays 0"), 2, "--rays");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --rays 10 --error 0.1"), 2, "excludes");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --emissivity 1.4"), 2, "--emissivity");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --sampling halton"), 2, "sobol");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --memory much"), 2, "--memory");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --memory 1KiB"), 2, "at least");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --hot-walls y_min"), 2, "add --box");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --box 0.01,0.01,0.01 --hot-walls left,y_min"),
              2, "left (no such wall; there are: x_min, x_max, y_min");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") +
                    " --box 0.01,0.01,0.01 --method lines --sampling random"),
              2, "--method embree");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --box 1,2"), 2, "X,Y,Z");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --box 1,2,x"), 2, "X,Y,Z");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --box 1,2,-3"), 2, "positive");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --radius -1"), 2, "--radius");
  for (const std::string option : {"rays", "error", "emissivity", "wall-emissivity", "radius"})
    expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --" + option + " nan"), 2,
                "--" + option + ": nan (must be a number in");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --radius 4mm"), 2, "4mm (must be a number");
  expect_says(vfgen("trace " + csv + " -o " + path("x.h5") + " --seed -1"), 2, "-1 (must be a whole number");
  expect_says(vfgen("trace " + csv + " -o " + path("x.txt")), 2, ".h5");
  expect_says(
      vfgen("trace " + csv + " -o " + path("x.h5") + " --box 0.01,0.01,0.01 --method lines --emissivity 0.5"),
      2, "embree");
  expect_says(vfgen("fit " + csv + " -o " + path("t.toml") + " --form quartic"), 2, "cubic");
  expect_says(vfgen("-q -v check x"), 2, "excludes");
  EXPECT_FALSE(fs::exists(path("x.h5")));
}

TEST_F(Vfgen, SaysWhichFileIsMissingWithCode3) {
  expect_says(vfgen("trace " + path("none.csv") + " -o " + path("x.h5")), 3, "none.csv");
  expect_says(vfgen("fit " + path("none.h5") + " -o " + path("t.toml")), 3, "none.h5");
  expect_says(vfgen("check " + path("none.toml")), 3, "none.toml");
  expect_says(vfgen("generate " + path("none.toml") + " -o " + path("out")), 3, "none.toml");
  expect_says(vfgen("trace " + two_spheres() + " -o /proc/none/x.h5"), 3, "/proc/none");
  // Found before hours of tracing, not after.
  const auto unwritable = vfgen("trace " + two_spheres() + " --walls none.stl -o /proc/none/x.h5");
  EXPECT_EQ(unwritable.text.find("none.stl"), std::string::npos) << unwritable.text;
  const auto second =
      vfgen("trace " + two_spheres() + " " + path("a.csv") + " " + path("b.csv") + " -o " + path("x.h5"));
  expect_says(second, 3, "a.csv: there is no such file");
  expect_says(second, 3, "b.csv");
  EXPECT_FALSE(fs::exists(path("x_0001.h5")));
  expect_says(vfgen("trace " + two_spheres() + " --rays 10 -o " + path("made/x.h5")), 0, "made/x.h5");
  expect_says(vfgen("trace " + two_spheres() + " --walls none.stl -o " + path("x.h5")), 3, "none.stl");
}

TEST_F(Vfgen, RefusesBadFilesWithCode2) {
  expect_says(vfgen("trace " + write("nan.csv", "x,y,z,radius\n0,0,nan,0.1\n") + " -o " + path("x.h5")), 2,
              "nan.csv:2");
  expect_says(vfgen("trace " + write("no_radius.csv", "x,y,z\n0,0,0\n") + " -o " + path("x.h5")), 2,
              "radius");
  expect_says(vfgen("trace " + write("negative.csv", "x,y,z,radius\n0,0,0,-1\n") + " -o " + path("x.h5")), 2,
              "negative.csv:2");
  expect_says(vfgen("check " + write("bad.toml", "form = \"cubic\"\n")), 2, "bad.toml");
  const auto config =
      write("generate.toml",
            "[snapshots]\nsolid_fractions = [0.9]\nsize_m = [1, 1, 1]\ndiameter_m = 0.9\ncolour = 1\n");
  const auto outcome = vfgen("generate " + config + " -o " + path("out"));
  expect_says(outcome, 2, "generate.toml:2");
  expect_says(outcome, 2, "generate.toml:4");
  expect_says(outcome, 2, "colour");
}

// A minute of rays, interrupted after a second.
TEST_F(Vfgen, InterruptLeavesNoFile) {
  // In the foreground timeout signals once; otherwise the group gets a second signal, which ends a program at
  // once.
  const auto outcome = run("timeout --foreground -s INT 1 " + std::string(VFGEN) + " trace " + two_spheres() +
                           " -o " + path("x.h5") + " --rays 3e7 --box 0.01,0.004,0.004");
  EXPECT_NE(outcome.text.find("nothing was kept"), std::string::npos) << outcome.text;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    files += entry.path().extension() != ".csv";
  EXPECT_EQ(files, 0u);
}

TEST_F(Vfgen, NumbersTheFilesOfSeveralSnapshots) {
  const auto csv = two_spheres();
  EXPECT_EQ(vfgen("-q trace " + csv + " " + csv + " -o " + path("many.h5") + " --rays 100").code, 0);
  EXPECT_TRUE(fs::exists(path("many_0001.h5")));
  EXPECT_TRUE(fs::exists(path("many_0002.h5")));
  EXPECT_FALSE(fs::exists(path("many.h5")));
}

TEST_F(Vfgen, GivesTheSameNumbersForAnyThreadCount) {
  const auto csv = two_spheres();
  EXPECT_EQ(vfgen("-q trace " + csv + " -o " + path("a.h5") + " --rays 20000 --threads 1").code, 0);
  EXPECT_EQ(vfgen("-q trace " + csv + " -o " + path("b.h5") + " --rays 20000 --threads 2").code, 0);
  EXPECT_EQ(granrad::read_view_factors(path("a.h5")).counts.hits,
            granrad::read_view_factors(path("b.h5")).counts.hits);
}

TEST_F(Vfgen, QuietSaysNothing) {
  EXPECT_EQ(vfgen("-q trace " + two_spheres() + " -o " + path("x.h5") + " --rays 100").text, "");
}

TEST_F(Vfgen, RefusesToFitGreyOrUnenclosedBeds) {
  const auto csv = two_spheres();
  ASSERT_EQ(vfgen("-q trace " + csv + " -o " + path("open.h5") + " --rays 100").code, 0);
  expect_says(vfgen("fit " + path("open.h5") + " -o " + path("t.toml")), 2, "enclose");
  ASSERT_EQ(vfgen("-q trace " + csv + " -o " + path("grey.h5") +
                  " --rays 100 --box 0.01,0.004,0.004 --emissivity 0.5 --wall-emissivity 0.8")
                .code,
            0);
  expect_says(vfgen("fit " + path("grey.h5") + " -o " + path("t.toml")), 2, "without --emissivity");
  EXPECT_FALSE(fs::exists(path("t.toml")));
}

// One snapshot is said, the same bed twice and a file whose self-check failed are refused, all at once.
TEST_F(Vfgen, RefusesToFitTheSameBedTwiceOrAFailedTrace) {
  std::string rows = "x,y,z,radius\n";
  for (int k = 0; k < 60; ++k)
    rows += std::to_string(0.001 * (k % 5) + 0.0007) + "," + std::to_string(0.001 * (k / 5 % 4) + 0.0006) +
            "," + std::to_string(0.001 * (k / 20) + 0.0005 + 1e-5 * k) + ",0.0004\n";
  const auto csv = write("bed.csv", rows);
  const std::string trace = "-q trace " + csv + " --box 0.005,0.004,0.004 --rays 300 -o ";
  ASSERT_EQ(vfgen(trace + path("a.h5")).code, 0);
  ASSERT_EQ(vfgen(trace + path("b.h5") + " --seed 2").code, 0);
  const auto twice = vfgen("fit " + path("a.h5") + " " + path("b.h5") + " -o " + path("t.toml"));
  expect_says(twice, 2, "b.h5: the same bed as");
  expect_says(twice, 2, "give each snapshot once");
  EXPECT_FALSE(fs::exists(path("t.toml")));
  const auto one = vfgen("fit " + path("a.h5") + " -o " + path("t.toml"));
  expect_says(one, 0, "one snapshot (nothing is held out");
  const auto refused = vfgen("trace " + csv + " --radius 0.0003 -o " + path("r.h5"));
  expect_says(refused, 2, "has radii of its own; drop --radius");
}

TEST_F(Vfgen, RefusesATableWithoutEnd) {
  std::ifstream in(source_dir + "/data/correlations/li_2024_printed.toml");
  std::stringstream text;
  text << in.rdbuf();
  auto endless = text.str();
  endless.replace(endless.find("pw_cutoff = 10"), 14, "pw_cutoff = 1e9");
  expect_says(vfgen("check " + write("endless.toml", endless)), 2, "pw_cutoff = 1000000000");
}

TEST_F(Vfgen, ChecksThePrintedTableAndReportsItsBadRow) {
  const auto outcome = vfgen("check " + source_dir + "/data/correlations/li_2024_printed.toml");
  expect_says(outcome, 2, "solid fraction 0.02: F_pw((h + r)/d = 1.00) = 0.61");
  expect_says(outcome, 2, "F_pp is negative from d* = 3.54");  // 0.43
}

TEST_F(Vfgen, FindsOurOwnTablesSound) {
  for (const char* table : {"granrad_hard_spheres", "granrad_hard_spheres_cubic", "granrad_moving_bed"})
    expect_says(vfgen("-q check " + source_dir + "/data/correlations/" + table + ".toml"), 0, "sound");
}

TEST_F(Vfgen, RefusesViewFactorsOfAnOlderVersion) {
  write_version_1(path("old.h5"));
  const auto outcome = vfgen("fit " + path("old.h5") + " -o " + path("t.toml"));
  expect_says(outcome, 2, "version = 1");
  expect_says(outcome, 2, "trace the snapshot again");
  ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("new.h5") + " --rays 10").code, 0);
  EXPECT_EQ(granrad::Hdf5Reader(path("new.h5")).integer_attribute("/", "version"), 2);
}

}  // namespace
}  // namespace granrad::vfgen_test
