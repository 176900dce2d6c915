// Requirement: a cell of history.csv without a value is empty, so that pandas reads it as missing; no zero
// and no nan stands for it.
#include <cmath>

#include "coupling/simulation/history.h"
#include "dem/base/constants.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

/// One sphere that falls into the region below it, hot walls around.
std::string falling_sphere(const std::string& particles) {
  return R"([scene]
name = "falling sphere"
end_time_s = 0.03
)" + scene_text::alumina +
         R"(emissivity = 0.8
[gas]
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
)" + particles +
         R"([box]
size_m = [0.004, 0.004, 0.006]
[region]
min_m = [0, 0, 0]
max_m = [0.004, 0.004, 0.003]
)" + scene_text::hot_across_y +
         R"([surroundings]
temperature_K = 300
[dem]
step_s = 1e-5
[radiation]
source = "paths"
rays = 500
every_s = 0.002
[output]
every_s = 0.01
)";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST(GranrunHistory, CellsWithoutAValueAreEmpty) {
  Scratch scratch;
  scratch.write("one.csv", "x,y,z,radius,temperature,vx,vy,vz\n0.002,0.002,0.0032,0.0004,300,0,0,-0.015\n");
  const auto scene = scratch.write("fall.toml", falling_sphere("file = \"one.csv\"\n")).string();
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q -o " + folder.string()).code, 0);
  const auto text = content(folder / "history.csv");
  const auto lines = lines_of(text);
  ASSERT_EQ(lines.size(), 4u);
  // The first row ends before the centre of the sphere is in, which falls at 15 mm/s from 0.2 mm above the region: time,
  // count, the fraction of its cap below the border, then no temperature.
  const double cap = 0.4e-3 - (0.2e-3 - 0.015 * 0.01);
  const double fraction = pi * cap * cap * (3 * 0.4e-3 - cap) / 3 / (0.004 * 0.004 * 0.003);
  EXPECT_EQ(lines[1].rfind("0.01,1,", 0), 0u) << lines[1];
  EXPECT_NE(lines[1].find(",,"), std::string::npos) << lines[1];
  EXPECT_EQ(lines[1].back(), '0') << lines[1];  // no heat left
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  const History history = read_history(folder / "history.csv");
  EXPECT_NEAR(history.at("solid_fraction")[0], fraction, 1e-9);
  EXPECT_TRUE(std::isnan(history.at("mean_temperature_K")[0]));
  EXPECT_TRUE(std::isnan(history.at("h_wp_W_m2K")[0]));
  EXPECT_TRUE(std::isnan(history.at("mean_velocity_m_s")[0]));
  EXPECT_TRUE(std::isnan(history.at("outlet_temperature_K")[2]));
  // The interval in which it comes in: driven by its own temperature, not by the mean with 0 K.
  const double warmed = history.at("mean_temperature_K")[1];
  EXPECT_GT(warmed, 300);
  EXPECT_LT(warmed, 301);
  EXPECT_NEAR(history.at("Q_rad_W")[1] / history.at("h_rad_W_m2K")[1], (1000 - warmed) * 2 * 0.004 * 0.003,
              1e-9);  // the area inside the region
  EXPECT_NEAR(history.at("mean_velocity_m_s")[1], 0.015, 1e-12);

  // Resumed, the rows before stay: those that end with an empty cell as well.
  ASSERT_EQ(
      granrun(scratch, "run " + scene + " -q --resume --set scene.end_time_s=0.04 -o " + folder.string())
          .code,
      0);
  EXPECT_EQ(content(folder / "history.csv").rfind(text, 0), 0u);
  ASSERT_EQ(granrun(scratch, "report " + folder.string()).code, 0);
  EXPECT_EQ(content(folder / "report.html").find("nan"), std::string::npos);
}

TEST(GranrunHistory, ARunWithoutParticlesHasNoTemperature) {
  Scratch scratch;
  scratch.write("one.csv", "x,y,z,radius\n0.002,0.002,0.005,0.0004\n");
  const auto scene = scratch.write("rest.toml", falling_sphere("file = \"one.csv\"\n")).string();
  const auto folder = scratch.root / "case";
  const auto outcome = granrun(scratch, "run " + scene + " -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 particles, none in the region"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err.find("nan"), std::string::npos) << outcome.err;
  EXPECT_EQ(content(folder / "run.json").find("null"), std::string::npos);
}
