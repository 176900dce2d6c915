// What a user types at vfgen and sees: options, files, messages and exit codes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "dem/base/files/hdf5_file.h"
#include "raytrace/exact.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/scene_text.h"
#include "tests/source_dir.h"

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

Outcome run(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const auto n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

Outcome vfgen(const std::string& arguments) {
  return run(std::string(VFGEN) + " " + arguments);
}

class Vfgen : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("granrad_vfgen_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }
  std::string two_spheres() const {
    return write("two.csv", "x,y,z,radius\n0.002,0.002,0.002,0.0004\n0.0032,0.002,0.002,0.0004\n");
  }
  fs::path folder_;
};

void expect_says(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.text;
  EXPECT_NE(outcome.text.find(part), std::string::npos) << "no '" << part << "' in\n" << outcome.text;
}

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

// 4 sigma of 1e5 rays from each of two spheres at d* = 1.5; a wrong emission law is caught by raytrace's own
// tests.
TEST_F(Vfgen, TracesTwoSpheresInABox) {
  expect_says(
      vfgen("trace " + two_spheres() + " -o " + path("two.h5") + " --rays 100000 --box 0.01,0.004,0.004"), 0,
      "self-check passed");
  const auto file = granrad::read_view_factors(path("two.h5"));
  ASSERT_EQ(file.enclosure.sphere_count(), 2u);
  ASSERT_EQ(file.enclosure.walls.size(), 6u);
  EXPECT_EQ(file.enclosure.walls[5].name, "z_max");
  const double exact = granrad::exact_two_sphere(0.0004, 0.0004, 0.0012);
  const double found = file.closed.value[file.closed.pattern.row_begin[0]] / file.closed.area_m2[0];
  EXPECT_EQ(file.closed.pattern.column[file.closed.pattern.row_begin[0]], 1);
  EXPECT_NEAR(found, exact, 4 * std::sqrt(exact / 2e5));
}

TEST_F(Vfgen, SaysWhatAnErrorCost) {
  const auto csv = two_spheres();
  for (const char* method : {"embree", "lines"}) {
    const auto outcome =
        vfgen("trace " + csv + " -o " + path("e.h5") +
              " --error 0.03 --hot-walls y_min,y_max --box 0.01,0.004,0.004 --method " + method);
    expect_says(outcome, 0, "of the particle fluxes from y_min,y_max (3 % asked for)");
    EXPECT_EQ(outcome.text.find('\r'), std::string::npos);
    const auto file = granrad::read_view_factors(path("e.h5"));
    EXPECT_LE(file.spent.error, 0.03);
    EXPECT_GT(file.spent.error, 0);
    EXPECT_GT(file.spent.rays, 0);
    EXPECT_GE(file.spent.rounds, 1);
    EXPECT_EQ(file.error_target, 0.03);
    EXPECT_EQ(file.hot_walls, "y_min,y_max");
    EXPECT_EQ(file.sampling, method == std::string("lines") ? "lines" : "sobol");
    const granrad::Hdf5Reader raw(path("e.h5"));
    const auto bound = raw.read<double>("/view_factors/zero_hit_bound");
    EXPECT_EQ(bound, granrad::zero_hit_bound(file.counts));
    EXPECT_EQ(bound.back(), 1);  // the surroundings send no rays
  }
  expect_says(vfgen("trace " + csv + " -o " + path("r.h5") + " --rays 200 --sampling random"), 0, "spent");
  EXPECT_EQ(granrad::read_view_factors(path("r.h5")).sampling, "random");
}

/// A box of 10 x 4 x 4 mm as an STL of two solids; inward normals, each solid turned round on demand.
std::string box_stl(bool turn_sides, bool turn_ends, bool without_first) {
  const double x = 0.01, y = 0.004, z = 0.004;
  const std::vector<std::array<std::array<double, 3>, 4>> faces = {
      {{{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}}}, {{{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}}},
      {{{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}}}, {{{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}}},
      {{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}}}, {{{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}}}};
  std::ostringstream text;
  for (std::size_t f = 0; f < 6; ++f) {
    if (f == 0) text << "solid sides\n";
    if (f == 4) text << "endsolid sides\nsolid ends\n";
    for (std::size_t t = without_first && f == 0 ? 1 : 0; t < 2; ++t) {
      std::array<std::size_t, 3> corner{0, t + 1, t + 2};
      if (f < 4 ? turn_sides : turn_ends) std::swap(corner[0], corner[2]);
      text << "facet normal 0 0 0\nouter loop\n";
      for (const auto c : corner)
        text << "vertex " << faces[f][c][0] << ' ' << faces[f][c][1] << ' ' << faces[f][c][2] << '\n';
      text << "endloop\nendfacet\n";
    }
  }
  text << "endsolid ends\n";
  return text.str();
}

TEST_F(Vfgen, TellsHowAnStlFitsTogether) {
  const auto traced = [&](bool turn_sides, bool turn_ends, bool without_first) {
    const auto stl = write("box.stl", box_stl(turn_sides, turn_ends, without_first));
    return vfgen("trace " + two_spheres() + " -o " + path("x.h5") + " --rays 1000 --walls " + stl);
  };
  expect_says(traced(false, false, false), 0, "12 triangles, closed, normals inward");
  const auto file = granrad::read_view_factors(path("x.h5"));
  ASSERT_EQ(file.enclosure.walls.size(), 2u);  // each solid is a wall, with rays in proportion to its area
  EXPECT_EQ(file.enclosure.walls[0].name, "walls.sides");
  EXPECT_EQ(file.enclosure.walls[1].name, "walls.ends");
  const auto density = [&](std::size_t i) {
    return static_cast<double>(file.counts.launched[i]) / file.counts.area_m2[i];
  };
  EXPECT_NEAR(density(2) / density(0), 1, 0.03);  // whole rays for each of 32 replicates
  EXPECT_NEAR(density(3) / density(0), 1, 0.03);
  expect_says(traced(false, false, true), 0, "not closed (3 open edges");
  // Turned to the particles, and said so: the same exchange as of the mesh that faces them.
  expect_says(traced(true, true, false), 0, "normals outward");
  expect_says(traced(true, true, false), 0, "wall walls.sides faced away from the particles and was turned");
  expect_says(traced(false, true, false), 0, "4 triangles turned to face as their neighbours");
  expect_says(traced(false, true, false), 0, "12 triangles, closed, normals inward");
  EXPECT_EQ(granrad::read_view_factors(path("x.h5")).counts.leaked, 0);
}

// Planted: the text taken for the name of a file, as it was (exit 3).
TEST_F(Vfgen, MeasureTakesMeshesInMillimetresToo) {
  const auto metres = write("metres.stl", box_stl(false, false, false));
  std::string small = box_stl(false, false, false);
  for (const char* number : {"0.004", "0.01"})
    for (std::size_t at = 0; (at = small.find(number, at)) != std::string::npos;)
      small.replace(at, std::string(number).size(), number == std::string("0.01") ? "10" : "4");
  const auto measured = [&](const std::string& walls) {
    const auto done = vfgen("measure " + two_spheres() + " --walls " + walls + " -o " + path("m") + " -q");
    EXPECT_EQ(done.code, 0) << done.text;
    std::ifstream in(path("m") + "/measure.json");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto as_metres = measured(metres);
  EXPECT_GT(as_metres.size(), 100u);
  EXPECT_EQ(as_metres, measured(write("millimetres.stl", small) + ":0.001"));
}

// A minute of rays, interrupted after a second.
TEST_F(Vfgen, InterruptLeavesNoFile) {
  // In the foreground timeout signals once; otherwise the group gets a second signal, which ends a program at
  // once.
  const auto outcome = run("timeout --foreground -s INT 1 " + std::string(VFGEN) + " trace " + two_spheres() +
                           " -o " + path("x.h5") + " --rays 3e7 --box 0.01,0.004,0.004");
  EXPECT_NE(outcome.text.find("nothing was kept"), std::string::npos) << outcome.text;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) files += entry.path().extension() != ".csv";
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

TEST_F(Vfgen, GeneratesTablesThatPassTheirCheckAndKeepsWhatIsThere) {
  const auto config = write("generate.toml", R"(title = "test"
[snapshots]
solid_fractions = [0.1, 0.3]
size_m = ["8 mm", "4 mm", "8 mm"]
diameter_m = "0.8 mm"
count = 2
[trace]
method = "embree"
rays = 300
)");
  expect_says(vfgen("generate " + config + " -o " + path("out")), 0, "transmittance.toml");
  expect_says(vfgen("check " + path("out/transmittance.toml")), 0, "sound");
  EXPECT_TRUE(fs::exists(path("out/cubic.html")));
  std::size_t files = 0;
  fs::path first;
  for (const auto& entry : fs::directory_iterator(path("out/traced"))) {
    EXPECT_EQ(entry.path().extension(), ".h5");
    first = entry.path();
    ++files;
  }
  EXPECT_EQ(files, 4u);
  const auto written = fs::last_write_time(first);
  const auto table = [&] {
    std::stringstream text;
    text << std::ifstream(path("out/cubic.toml")).rdbuf();
    return text.str();
  };
  const auto before = table();
  EXPECT_EQ(vfgen("-q generate " + config + " -o " + path("out")).code, 0);
  EXPECT_EQ(fs::last_write_time(first), written);  // not traced again
  EXPECT_EQ(table(), before);
  // The same files through `fit`: two rows, each from two snapshots.
  expect_says(vfgen("fit " + path("out/traced") + "/*.h5 -o " + path("t.toml") +
                    " --form transmittance --report " + path("t.html")),
              0, "t.html");
  EXPECT_TRUE(fs::exists(path("t.html")));
}

/// A short plug of 0.5 mm spheres, dilute and fast: tens of milliseconds of residence.
const std::string short_plug = R"([scene]
name = "short_plug"
end_time_s = 0.1
[material]
density_kg_m3 = 2500
specific_heat_J_kgK = 800
conductivity_W_mK = 1
youngs_modulus_Pa = 5e6
poisson_ratio = 0.23
restitution = 0.5
friction = 0.3
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
[box]
size_m = [0.006, 0.004, 0.008]
)" + granrad::scene_text::walls({}) +
                               R"([feed]
kind = "plug"
solid_fraction = 0.2
mass_flow_kg_s = "2 g/s"
[dem]
engine = "native"
step_s = 1e-5
[radiation]
source = "paths"
[output]
every_s = 0.01
)";

// Runs a plug at two solid fractions until it is steady, traces and fits; a second call keeps runs and traces.
// Planted error: the label of a row from the spheres whose centre is inside over the stretched box -> 0.18.
TEST_F(Vfgen, GeneratesATableFromFlows) {
  write("plug.toml", short_plug);
  const auto config = write("flow.toml", R"(title = "plugs"
[flow]
scene = "plug*.toml"
solid_fractions = [0.1, 0.2]
seeds = 2
snapshots = 2
curve_error = 1
every_s = 0.005
[trace]
rays = 300
[fit]
form = "transmittance"
)");
  const auto outcome = vfgen("generate " + config + " -o " + path("out"));
  expect_says(outcome, 0, "transmittance.toml");
  EXPECT_TRUE(fs::exists(path("out/transmittance.html")));
  EXPECT_TRUE(fs::exists(path("out/transmittance.check.txt")));
  const auto table = [&] {
    std::stringstream text;
    text << std::ifstream(path("out/transmittance.toml")).rdbuf();
    return text.str();
  };
  const auto first = table();
  const auto at = first.find("solid_fraction = 0.2");
  EXPECT_NE(at, std::string::npos) << first;
  EXPECT_NE(first.find("snapshots = 2"), std::string::npos) << first;
  fs::path traced;
  for (const auto& entry : fs::directory_iterator(path("out/traced"))) traced = entry.path();
  const auto written = fs::last_write_time(traced);
  EXPECT_EQ(vfgen("-q generate " + config + " -o " + path("out")).code, 0);
  EXPECT_EQ(fs::last_write_time(traced), written);
  EXPECT_EQ(table(), first);
}

TEST_F(Vfgen, GenerateSaysWhatIsWrongWithFlows) {
  const auto config = write(
      "flow.toml", "[flow]\nscene = \"none*.toml\"\nfolders = [\"x\"]\nsnapshots = 5\nmost_snapshots = 2\n");
  const auto outcome = vfgen("generate " + config + " -o " + path("out"));
  expect_says(outcome, 2, "flow.toml:2");
  expect_says(outcome, 2, "give exactly one");
  expect_says(outcome, 2, "most_snapshots");
  write("bad.toml", std::string(short_plug) + "colour = 1\n");
  const auto bad = write("bad_flow.toml", "[flow]\nscene = \"bad.toml\"\n");
  expect_says(vfgen("generate " + bad + " -o " + path("out2")), 2, "ended with code 2");
}

/// Version 1 held one variance factor for all pairs, as a dataset.
void write_version_1(const fs::path& file) {
  granrad::Hdf5Writer old(file);
  old.attribute("/", "format", std::string("granrad.view_factors"));
  old.attribute("/", "version", std::vector<std::int64_t>{1});
  old.write("/rays/variance_factor", std::vector<double>{1});
  old.commit();
}

TEST_F(Vfgen, RefusesViewFactorsOfAnOlderVersion) {
  write_version_1(path("old.h5"));
  const auto outcome = vfgen("fit " + path("old.h5") + " -o " + path("t.toml"));
  expect_says(outcome, 2, "version = 1");
  expect_says(outcome, 2, "trace the snapshot again");
  ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("new.h5") + " --rays 10").code, 0);
  EXPECT_EQ(granrad::Hdf5Reader(path("new.h5")).integer_attribute("/", "version"), 2);
}

/// The name vfgen generate gives the first traced file at 0.3 of the bed below, as each version of the format
/// made it: FNV-1a of what it depends on.
std::string traced_name(int version) {
  const std::string depends =
      "packing 1 0.008 0.004 0.008 0.0008 100 1 trace " + std::to_string(version) + " lines 300 1 0.3 1";
  std::uint32_t hash = 2166136261u;
  for (const char c : depends) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  char name[64];
  std::snprintf(name, sizeof name, "phi_0.3000_01_%08x.h5", hash);
  return name;
}

// Planted: the version left out of the name, so that the old file is taken for the one wanted.
TEST_F(Vfgen, GenerateTracesAnewWhatAnOlderVersionHolds) {
  const auto config = write("generate.toml", R"([snapshots]
solid_fractions = [0.3]
size_m = [0.008, 0.004, 0.008]
diameter_m = 0.0008
[trace]
rays = 300
[fit]
form = "transmittance"
)");
  const fs::path traced = path("out/traced");
  fs::create_directories(traced);
  write_version_1(traced / traced_name(1));
  ASSERT_EQ(vfgen("-q generate " + config + " -o " + path("fresh")).code, 0);
  const auto outcome = vfgen("generate " + config + " -o " + path("out"));
  expect_says(outcome, 0, "transmittance.toml");
  ASSERT_TRUE(fs::exists(traced / traced_name(2))) << "the rule of the names has changed: mend this test";
  EXPECT_EQ(granrad::Hdf5Reader(traced / traced_name(2)).integer_attribute("/", "version"), 2);
  EXPECT_EQ(granrad::Hdf5Reader(traced / traced_name(1)).integer_attribute("/", "version"), 1);
  const auto table = [&](const std::string& folder) {
    std::stringstream text;
    text << std::ifstream(path(folder + "/transmittance.toml")).rdbuf();
    return text.str();
  };
  EXPECT_EQ(table("out"), table("fresh"));
  EXPECT_FALSE(table("out").empty());
}

// Planted: the time a trace took, written into the file.
TEST_F(Vfgen, SameBytesForAnyNumberOfThreads) {
  const auto bytes = [&](const std::string& name) {
    std::stringstream content;
    content << std::ifstream(path(name), std::ios::binary).rdbuf();
    return content.str();
  };
  for (const std::string method : {"embree", "lines"}) {
    for (const std::string threads : {"1", "2"})
      ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("t" + threads + ".h5") +
                      " --rays 1000 --box 0.01,0.004,0.004 --method " + method + " --threads " + threads)
                    .code,
                0);
    EXPECT_TRUE(bytes("t1.h5") == bytes("t2.h5")) << method;
  }
}

// A scalar text of variable length is a str in h5py, one of fixed length is bytes: format == "..." would
// fail.
TEST_F(Vfgen, AttributesAreTextsOfVariableLength) {
  ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("a.h5") + " --rays 10").code, 0);
  const auto dump = run("h5dump -a /format -a /method -a /failed " + path("a.h5"));
  ASSERT_EQ(dump.code, 0) << "h5dump is missing; apt-get install hdf5-tools";
  EXPECT_EQ(dump.text.find("STRSIZE 2"), std::string::npos) << dump.text;
  EXPECT_NE(dump.text.find("STRSIZE H5T_VARIABLE"), std::string::npos) << dump.text;
  EXPECT_EQ(granrad::read_view_factors(path("a.h5")).method, "embree");
}

// Planted: periods kept; the sphere beyond the box is folded back into it.
TEST_F(Vfgen, BoxEndsThePeriodsOfADump) {
  const auto dump =
      write("pp.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 0.01\n0 "
            "0.004\n0 0.004\nITEM: ATOMS id x y z\n1 0.002 0.002 0.002\n2 0.0032 0.002 0.002\n");
  const auto outcome =
      vfgen("trace " + dump + " --radius 4e-4 --box 0.003,0.004,0.004 --rays 1000 -o " + path("x.h5"));
  expect_says(outcome, 0, "1 particles with their centre outside the box were left out");
  const auto enclosure = granrad::read_view_factors(path("x.h5")).enclosure;
  EXPECT_EQ(enclosure.sphere_count(), 1u);
  EXPECT_EQ(enclosure.periodic, (std::array<bool, 3>{}));
}

// Planted: pairs of one size class alone, no periodic image, depth measured by the larger radius.
TEST_F(Vfgen, RemarksOnGrossOverlaps) {
  const auto tracing = [&](const std::string& file, const std::string& text) {
    return vfgen("trace " + write(file, text) + " --rays 10 -o " + path("x.h5"));
  };
  const std::string first = "x,y,z,radius\n0,0,0,1\n", far = "9,9,9,1\n";
  const auto deep = tracing("deep.csv", first + far + "1.4,0,0,1\n");
  expect_says(deep, 0, "deep.csv: 1 pair of particles, ids 1-3 overlap by more than half a radius");
  EXPECT_EQ(tracing("less.csv", first + far + "1.6,0,0,1\n").text.find("overlap"), std::string::npos);
  expect_says(tracing("small.csv", first + "1,0,0,0.1\n"), 0, "ids 1-2 overlap");
  EXPECT_EQ(tracing("poking.csv", first + "1.06,0,0,0.1\n").text.find("overlap"), std::string::npos);
  std::string row = "x,y,z,radius\n";
  for (int k = 0; k < 20; ++k) row += std::to_string(k) + ",0,0,1\n";
  expect_says(tracing("row.csv", row), 0, "19 pairs of particles, ids 1-2, 2-3, 3-4, 4-5, 5-6, ");
  expect_says(tracing("row.csv", row), 0, "10-11, ... overlap");

  fs::remove(path("x.h5"));
  const auto same = tracing("same.csv", first + far + "0,0,0,1\n9,9,9,0.5\n");
  expect_says(same, 2, "same.csv: 2 pairs of particles, ids 1-3, 2-4 are in the same place");
  EXPECT_FALSE(fs::exists(path("x.h5")));
  const auto periodic =
      write("pp.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n"
            "0 9\nITEM: ATOMS id x y z radius\n7 0.1 1 1 1\n4 8.9 1 1 1\n");
  expect_says(vfgen("trace " + periodic + " --rays 100 -o " + path("x.h5")), 0, "ids 4-7 overlap");
  // A radius in the wrong unit: everything overlaps, and it is said at once.
  std::string cloud = "x,y,z,radius\n";
  for (int k = 0; k < 3000; ++k) cloud += std::to_string(k) + ",0,0,5000\n";
  const auto text = tracing("cloud.csv", cloud).text;
  EXPECT_EQ(text.rfind("warning: ", 0), 0u) << text;
  EXPECT_NE(text.find("at least 100"), std::string::npos) << text;
}

TEST_F(Vfgen, AnErrorOutOfReachIsCode4) {
  expect_says(vfgen("trace " + two_spheres() + " --box 0.0101,0.0104,0.0204 --error 1e-6 -o " + path("x.h5")),
              4, "ask for less");
  EXPECT_FALSE(fs::exists(path("x.h5")));
}

// Tracing on until the most directions have missed it would take an hour: the suite's own limit ends it.
TEST_F(Vfgen, AnErrorOutOfReachOfLinesIsForeseen) {
  const auto outcome = vfgen("trace " + two_spheres() +
                             " --box 0.01,0.004,0.004 --method lines --error 1e-6 -o " + path("x.h5"));
  expect_says(outcome, 4, "error = 1e-06 (reached 0.0");
  expect_says(outcome, 4, "rays per particle, would need about");
  expect_says(outcome, 4, "the most are 1.6e+09, for about");
  EXPECT_FALSE(fs::exists(path("x.h5")));
}

}  // namespace
