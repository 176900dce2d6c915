// Requirement: the flow on LIGGGHTS runs on several ranks: spheres that meet across the ranks' parts of the domain move as
// on one rank but for the order of sums, springs between parts survive the hand-over at every heat step, ranks without
// spheres do no harm, the books close, and a case goes on with another number of ranks.
// Planted: springs handed to the rank of one of the two spheres only, springs left in the order of the ranks
// (ABedMovesAsOnOneRankLong).
#include <cmath>

#include "coupling/simulation/history.h"
#include "dem/io/snapshot.h"
#include "liggghts_built.h"
#include "mpirun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

class RanksLiggghts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!ranks_are_built() || !liggghts_is_built())
      GTEST_SKIP() << "built without MPI or LIGGGHTS, or no mpirun";
  }

  /// small_plug without its feed, started from a file, under gravity.
  std::string scene_of(const std::string& rows, const std::string& size = "") {
    scratch.write("bed.csv", "x,y,z,radius,temperature,vx,vy,vz,omegax,omegay,omegaz\n" + rows);
    std::string text = small_plug;
    const auto feed = text.find("[feed]");
    text.erase(feed, text.find("[dem]") - feed);
    text = edited(text, "diameter_m = \"0.8 mm\"\ntemperature_K = 300", "file = \"bed.csv\"");
    text = edited(text, "end_time_s = 0.04", "end_time_s = 0.002\ngravity_m_s2 = [0, 0, -9.81]");
    text = edited(text, "every_s = 0.004", "every_s = 0.001");
    if (!size.empty()) text = edited(text, "[0.004, 0.003, 0.006]", size);
    return scratch.write("bed.toml", text).string();
  }
  std::string line(const std::string& scene, const fs::path& folder, const std::string& more = "") {
    return "run " + scene + " -q --threads 1 --set dem.engine=liggghts -o " + folder.string() + more;
  }
  void expect_near(const fs::path& a, const fs::path& b, double position_radii, double relative) {
    const Bed one = read_frame(last_frame(a)).bed, other = read_frame(last_frame(b)).bed;
    ASSERT_EQ(one.id, other.id);
    ASSERT_EQ(one.contacts.size(), other.contacts.size());
    for (std::size_t k = 0; k < one.contacts.size(); ++k)
      EXPECT_TRUE(one.contacts[k].first == other.contacts[k].first &&
                  one.contacts[k].second == other.contacts[k].second)
          << k;
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_LE(norm(one.position_m[i] - other.position_m[i]), position_radii * one.radius_m[i]) << i;
      EXPECT_LE(norm(one.velocity_m_s[i] - other.velocity_m_s[i]), relative) << i;
      EXPECT_NEAR(one.temperature_K[i] / other.temperature_K[i], 1, relative) << i;
    }
  }
  Scratch scratch;
};

/// 160 spheres that touch, pushed and spun: friction builds springs everywhere.
std::string packed_rows() {
  std::string rows;
  for (int k = 0; k < 160; ++k) {
    const double shift = 2e-6 * std::sin(3.0 * k), d = 7.992e-4;
    const auto at = [&](int n, double s) { return std::to_string(1e3 * (d * (n + 0.5) + s)) + "e-3,"; };
    const int place = k * 37 % 160;  // ids of each rank's spheres are scattered
    rows += at(place % 5, shift) + at(place / 5 % 4, -shift) + at(place / 20, shift) + "4e-4," +
            std::to_string(300 + k % 7) + "," + std::to_string(0.05 * std::sin(k)) + "," +
            std::to_string(0.05 * std::cos(2 * k)) + "," + std::to_string(0.05 * std::sin(5 * k)) + "," +
            std::to_string(20 * std::sin(k)) + "," + std::to_string(20 * std::cos(k)) + ",5\n";
  }
  return rows;
}

// Two spheres meet in the middle of the box, where two ranks' parts meet; of three ranks one has none.
TEST_F(RanksLiggghts, TwoSpheresMeetAcrossParts) {
  const auto scene = scene_of(
      "0.0019,0.0015,0.0029,4e-4,300,0.1,0,0,0,10,0\n"
      "0.0022,0.0015,0.00366,4e-4,310,-0.1,0.02,-0.1,5,0,0\n");
  const auto alone = scratch.root / "alone";
  ASSERT_EQ(granrun(scratch, line(scene, alone)).code, 0);
  for (const int r : {2, 3}) {
    const auto shared = scratch.root / ("ranks" + std::to_string(r));
    const auto outcome = run_on_ranks(scratch, r, "granrun", line(scene, shared));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_near(alone, shared, 1e-11, 1e-11);
  }
}

TEST_F(RanksLiggghts, ABedMovesAsOnOneRankLong) {
  const auto scene = scene_of(packed_rows(), "[0.004, 0.0032, 0.0064]");
  const auto alone = scratch.root / "alone", shared = scratch.root / "shared";
  ASSERT_EQ(granrun(scratch, line(scene, alone)).code, 0);
  const auto outcome = run_on_ranks(scratch, 2, "granrun", line(scene, shared));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_near(alone, shared, 1e-9, 1e-8);
  ASSERT_GT(read_frame(last_frame(shared)).bed.contacts.size(), 200u);
  for (const double defect : read_history(shared / "history.csv").at("energy_defect"))
    EXPECT_LE(defect, 1e-9);
}

TEST_F(RanksLiggghts, ABedGoesOnWithAnotherNumberOfRanksLong) {
  const auto scene = scene_of(packed_rows(), "[0.004, 0.0032, 0.0064]");
  const auto alone = scratch.root / "alone", resumed = scratch.root / "resumed";
  ASSERT_EQ(granrun(scratch, line(scene, alone)).code, 0);
  ASSERT_EQ(run_on_ranks(scratch, 4, "granrun", line(scene, resumed, " --set scene.end_time_s=0.001")).code,
            0);
  ASSERT_EQ(run_on_ranks(scratch, 3, "granrun", line(scene, resumed, " --resume")).code, 0);
  expect_near(alone, resumed, 1e-9, 1e-8);
}

// The spheres fill a sixteenth of the box: cut in equal parts, three of four ranks would have none.
TEST_F(RanksLiggghts, AnUnevenBedMovesAsOnOneRankLong) {
  const auto scene = scene_of(packed_rows(), "[0.016, 0.006, 0.014]");
  const auto alone = scratch.root / "alone", shared = scratch.root / "shared";
  ASSERT_EQ(granrun(scratch, line(scene, alone)).code, 0);
  ASSERT_EQ(run_on_ranks(scratch, 4, "granrun", line(scene, shared)).code, 0);
  expect_near(alone, shared, 1e-9, 1e-8);
}

// Spheres touch across the periods, and parts meet there too.
TEST_F(RanksLiggghts, APeriodicBedMovesAsOnOneRankLong) {
  const auto scene = scene_of(packed_rows(), "[0.003996, 0.0031968, 0.0075]\nperiodic = [\"x\", \"y\"]");
  const std::string floor =
      " --unset walls.x_min --unset walls.x_max --unset walls.y_min --unset walls.y_max"
      " --set walls.z_min.role=isothermal --set walls.z_min.temperature_K=900";
  const auto alone = scratch.root / "alone", shared = scratch.root / "shared";
  ASSERT_EQ(granrun(scratch, line(scene, alone, floor)).code, 0);
  ASSERT_EQ(run_on_ranks(scratch, 3, "granrun", line(scene, shared, floor)).code, 0);
  expect_near(alone, shared, 1e-9, 1e-8);
}

// The feed brings the same spheres; collisions part their ways, and the heat and flow of all agree.
TEST_F(RanksLiggghts, APlugFlowsAndHeatsAlikeLong) {
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto alone = scratch.root / "alone";
  ASSERT_EQ(granrun(scratch, line(scene, alone)).code, 0);
  const History one = read_history(alone / "history.csv");
  for (const int r : {2, 4}) {
    SCOPED_TRACE(r);
    const auto shared = scratch.root / ("ranks" + std::to_string(r));
    const auto outcome = run_on_ranks(scratch, r, "granrun", line(scene, shared));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const History many = read_history(shared / "history.csv");
    EXPECT_EQ(many.at("mass_flow_in_kg_s"), one.at("mass_flow_in_kg_s"));
    for (const double defect : many.at("energy_defect")) EXPECT_LE(defect, 1e-9);
    const double spheres = one.at("particle_count").back();
    EXPECT_NEAR(many.at("solid_fraction").back(), one.at("solid_fraction").back(),
                2 * one.at("solid_fraction").back() / std::sqrt(spheres));
    EXPECT_NEAR((many.at("mean_temperature_K").back() - 300) / (one.at("mean_temperature_K").back() - 300), 1,
                0.02);
  }
}

TEST_F(RanksLiggghts, TheDeathOfARankEndsTheOthersAndResumesExactlyLong) {
  const auto scene = scratch.write("plug.toml", small_plug), stopped = scratch.root / "stopped",
             whole = scratch.root / "whole";
  const std::string engine = " --set dem.engine=liggghts";
  EXPECT_NE(stopped_by(scratch, scene, stopped, SIGKILL, 2, engine), 0);
  for (int wait = 0; wait < 200 && !ranks_on(stopped).empty(); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(ranks_on(stopped).empty());
  const std::string name = last_frame(stopped).filename();
  const auto end = engine + " -q --threads 1 --set scene.end_time_s=" +
                   std::to_string((std::stod(name.substr(2, 9)) + 300) * 1e-5) + " -o ";
  const auto run = "run " + scene.string() + end;
  ASSERT_EQ(run_on_ranks(scratch, 2, "granrun", run + stopped.string() + " --resume").code, 0);
  ASSERT_EQ(run_on_ranks(scratch, 2, "granrun", run + whole.string()).code, 0);
  expect_same_case(whole, stopped);
}

}  // namespace
