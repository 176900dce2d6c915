// What vfgen generate makes: tables that pass their check, from packings and from flows; what is there is kept.
#include "tests/cli/vfgen_fixture.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/base/files/hdf5_file.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/scene_text.h"
#include "tests/source_dir.h"

namespace granrad::vfgen_test {
namespace {

const std::string source_dir = granrad::source_dir();

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

}  // namespace
}  // namespace granrad::vfgen_test
