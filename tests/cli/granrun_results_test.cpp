// Requirement: results mean something: heat of every wall, coefficients only where one temperature drives them, means
// with honest errors and windows, and what lies outside the heat-transfer region is said.
#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/simulation/history.h"
#include "coupling/simulation/wall_history.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

const char* const head = R"([scene]
name = "results"
end_time_s = 0.01
[material]
density_kg_m3 = 2500
specific_heat_J_kgK = 800
conductivity_W_mK = 1
youngs_modulus_Pa = 5e6
poisson_ratio = 0.3
restitution = 0.5
friction = 0.3
[particles]
file = "bed.csv"
)";

nlohmann::json results_of(const fs::path& folder) {
  return nlohmann::json::parse(content(folder / "results.json"));
}

}  // namespace

// A chain of ten spheres between 1000 K and 300 K: a series of nine contacts 2 k sqrt(pi/4 (d^2 - D^2)) and two walls
// 2 k sqrt(pi (R^2 - h^2)). Catches heat of walls mixed up or lost (to plant: given_J of the next wall), and h from a
// mean wall temperature.
TEST(GranrunResults, ChainBetweenHotAndColdTellsTheHeatOfEachWall) {
  Scratch scratch;
  const double d = 0.01, gap = 0.00996, edge = 0.00498, k = 10;
  std::string bed = "x,y,z,radius,temperature\n";
  for (int i = 0; i < 10; ++i)
    bed += std::to_string(edge + i * gap) + ",0.02,0.02,0.005," + std::to_string(970 - 64 * i) + "\n";
  scratch.write("bed.csv", bed);
  const auto scene = scratch.write(
      "chain.toml", edited(edited(head, "conductivity_W_mK = 1\n", "conductivity_W_mK = 10\n"),
                           "end_time_s = 0.01", "end_time_s = 20000") +
                        "[box]\nsize_m = [0.0996, 0.04, 0.04]\n[walls.x_min]\nrole = \"isothermal\"\n"
                        "temperature_K = 1000\n[walls.x_max]\nrole = \"isothermal\"\ntemperature_K = 300\n"
                        "[dem]\nengine = \"none\"\n[output]\nevery_s = 400\nframes_every_s = 4000\n");
  const auto folder = scratch.root / "case";
  const auto outcome = granrun(scratch, "run " + scene.string() + " -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("several temperatures"), std::string::npos) << outcome.err;
  const double pi = std::acos(-1.0), pair = 2 * k * std::sqrt(pi / 4 * (d * d - gap * gap)),
               wall = 2 * k * std::sqrt(pi * (d * d / 4 - edge * edge));
  const double heat_W = 700 / (9 / pair + 2 / wall);
  const auto results = results_of(folder);
  EXPECT_TRUE(results["steady"]);
  EXPECT_NEAR(results["walls"]["x_min"]["Q_ss_W"]["mean"], heat_W, 2e-4 * heat_W);
  EXPECT_NEAR(results["walls"]["x_max"]["Q_ss_W"]["mean"], -heat_W, 2e-4 * heat_W);
  EXPECT_NEAR(results["walls"]["x_min"]["flux_W_m2"]["mean"], heat_W / 0.0016, 2e-4 * heat_W / 0.0016);
  EXPECT_FALSE(results["means"].contains("h_wp_W_m2K"));
  const auto history = read_history(folder / "history.csv");
  for (double h : history.at("h_wp_W_m2K")) EXPECT_TRUE(std::isnan(h));
}

// The heats of walls.csv add up to those of history.csv, path by path.
TEST(GranrunResults, WallsAddUpAndSurviveAStop) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto whole = scratch.root / "whole", stopped = scratch.root / "stopped";
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q -o " + whole.string()).code, 0);
  const auto history = read_history(whole / "history.csv");
  const auto walls = read_wall_history(whole / "walls.csv");
  ASSERT_EQ(walls.size(), 7 * history.at("time_s").size());  // six and the surroundings
  for (std::size_t row = 0; row < history.at("time_s").size(); ++row) {
    double solid = 0, gas = 0, radiation = 0;
    for (std::size_t w = 0; w < 7; ++w) {
      const auto& one = walls[7 * row + w];
      EXPECT_NEAR(one.time_s, history.at("time_s")[row], 1e-12);
      solid += one.Q_ss_W, gas += one.Q_sfs_W, radiation += one.Q_rad_W;
    }
    EXPECT_NEAR(solid, history.at("Q_ss_W")[row], 1e-9 * std::abs(solid) + 1e-15);
    EXPECT_NEAR(gas, history.at("Q_sfs_W")[row], 1e-9 * std::abs(gas) + 1e-15);
    EXPECT_NEAR(radiation, history.at("Q_rad_W")[row], 1e-9 * std::abs(radiation));
  }
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q --set scene.end_time_s=0.012 -o " + stopped.string()).code,
            0);
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q --resume -o " + stopped.string()).code, 0);
  EXPECT_EQ(content(whole / "walls.csv"), content(stopped / "walls.csv"));
  EXPECT_EQ(content(whole / "results.json"), content(stopped / "results.json"));
}

TEST(GranrunResults, SayWhenAFlowIsNotSteadyAndAverageWhereAsked) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto folder = scratch.root / "case";
  const auto outcome = granrun(scratch, "run " + scene + " -o " + folder.string());
  ASSERT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("not steady: T rises "), std::string::npos) << outcome.out;
  const auto results = results_of(folder);
  EXPECT_FALSE(results["steady"]);
  EXPECT_NEAR(results["window"]["from_s"], 0.02, 1e-12);  // the second half
  EXPECT_GT(results["means"]["Nu_d_rad"]["standard_error"], 0);
  EXPECT_NEAR(results["means"]["share_ss"]["mean"].get<double>() +
                  results["means"]["share_sfs"]["mean"].get<double>() +
                  results["means"]["share_rad"]["mean"].get<double>(),
              1, 1e-9);
  const auto later = scratch.root / "later";
  ASSERT_EQ(
      granrun(scratch, "run " + scene + " -q --set output.average_from_s=0.032 -o " + later.string()).code,
      0);
  EXPECT_NEAR(results_of(later)["window"]["from_s"], 0.032, 1e-12);
  EXPECT_EQ(granrun(scratch, "check " + scene + " --set output.average_from_s=1").code, 2);
}

TEST(GranrunResults, SayWhatLiesOutsideTheRegion) {
  Scratch scratch;
  scratch.write("bed.csv", "x,y,z,radius\n0.005,0.005,-0.0151,0.005\n");
  const auto scene = scratch.write(
      "tray.toml", std::string(head) +
                       "[box]\nsize_m = [0.01, 0.01, 0.01]\nwalls = false\n[[polygon]]\nname = \"tray\"\n"
                       "vertices_m = [[0,0,-0.02],[0.01,0,-0.02],[0.01,0.01,-0.02],[0,0.01,-0.02]]\n"
                       "role = \"isothermal\"\ntemperature_K = 1000\n[dem]\nengine = \"none\"\n[output]\n"
                       "every_s = 0.001\n");
  const auto checked = granrun(scratch, "check " + scene.string());
  ASSERT_EQ(checked.code, 0) << checked.err;
  EXPECT_NE(checked.out.find("outside the heat-transfer region: tray"), std::string::npos) << checked.out;
  EXPECT_NE(checked.out.find("1 of 1 particles lie outside the heat-transfer region"), std::string::npos)
      << checked.out;
  EXPECT_NE(checked.out.find("walls isothermal: tray"), std::string::npos) << checked.out;
}

// With Y/Y_real = 5e6 / 414e9 the exponent 1/5 instead of 1/3 conducts (414e9/5e6)^(2/15) = 4.5 times too well.
TEST(GranrunResults, AskForTheModulusExponentOfABedAtRest) {
  Scratch scratch;
  scratch.write("bed.csv", "x,y,z,radius\n0.005,0.005,0.005,0.001\n");
  const auto frozen =
      edited(head, "youngs_modulus_Pa = 5e6\n", "youngs_modulus_Pa = 5e6\nreal_youngs_modulus_Pa = 414e9\n") +
      "[box]\nsize_m = [0.01, 0.01, 0.01]\n[dem]\nengine = \"none\"\n";
  const auto scene = scratch.write("rest.toml", frozen).string();
  const auto checked = granrun(scratch, "check " + scene);
  EXPECT_NE(checked.out.find("conduct 4.5 times too well"), std::string::npos) << checked.out;
  for (const char* chosen : {"0.2", "0.3333"})
    EXPECT_EQ(granrun(scratch, "check " + scene + " --set conduction.modulus_exponent=" + chosen)
                  .out.find("too well"),
              std::string::npos);
}

// One sphere falls past a tile: [[remove]] takes it out, counted; without it the run must not go on in silence.
TEST(GranrunResults, StraySpheresAreRemovedAndCounted) {
  Scratch scratch;
  scratch.write("bed.csv",
                "x,y,z,radius,temperature\n0.005,0.005,0.0012,0.001,300\n0.001,0.005,0.0012,0.001,400\n");
  const auto scene = scratch.write(
      "tile.toml", edited(edited(head, "end_time_s = 0.01", "end_time_s = 0.3\ngravity_m_s2 = [0, 0, -9.81]"),
                          "friction = 0.3", "friction = 0.3") +
                       "[box]\nsize_m = [0.01, 0.01, 0.01]\nwalls = false\n[[polygon]]\nname = \"tile\"\n"
                       "vertices_m = [[0.004,0.004,0],[0.006,0.004,0],[0.006,0.006,0],[0.004,0.006,0]]\n"
                       "[[remove]]\nbelow_m = { axis = \"z\", value = -0.02 }\n[output]\nevery_s = 0.1\n");
  const auto folder = scratch.root / "case";
  const auto outcome = granrun(scratch, "run " + scene.string() + " -q -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto history = read_history(folder / "history.csv");
  EXPECT_EQ(history.at("particle_count").back(), 1);
  const double mass = 2500 * 4 / 3.0 * std::acos(-1.0) * 1e-9;
  double left_kg = 0, left_J = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    left_kg += 0.1 * history.at("mass_flow_out_kg_s")[k];
    left_J += 0.1 * history.at("heat_out_W")[k];
    EXPECT_LE(history.at("energy_defect")[k], 1e-10)
        << "nothing is received: rounding over 1e-5 of the energy";
  }
  EXPECT_NEAR(left_kg, mass, 1e-9 * mass);
  EXPECT_NEAR(left_J, mass * 800 * 400, 1e-9 * left_J);
  EXPECT_EQ(granrun(scratch, "check " + scene.string() + " --set dem.engine=none").code, 2);
  const auto lost =
      granrun(scratch, "run " + scene.string() + " -q --set remove=[] --set scene.end_time_s=5 -o " +
                           (scratch.root / "lost").string());
  EXPECT_EQ(lost.code, 1);
  EXPECT_NE(lost.err.find("[[remove]]"), std::string::npos) << lost.err;
}

// The intervals of sources that are compared are those of the scene: a key that would be ignored is unknown.
TEST(GranrunResults, ComparedSourcesHaveNoIntervalOfTheirOwn) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto refused = granrun(scratch, "check " + scene +
                                            " --set validate.reference.source=paths --set "
                                            "validate.reference.every_s=0.01");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("validate.reference.every_s"), std::string::npos) << refused.err;
}

TEST(GranrunResults, VerboseSaysMore) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto outcome = granrun(scratch, "run " + scene + " -v -o " + (scratch.root / "case").string());
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("t = 0.02 s  N = "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("MB at most"), std::string::npos) << outcome.err;
}
