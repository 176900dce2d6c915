// Requirement: what a run cannot compute, or what stops it, in the middle of a step leaves a checkpoint of the state
// before that step, names the key, and --resume goes on from there, with another step where one is given.
#include <csignal>
#include <thread>

#include "coupling/simulation/history.h"
#include "dem/io/snapshot.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

/// Two spheres that meet after 1 ms, of a solid that conducts so well that 50 steps are too long a heat step then.
std::string sudden_contact(const Scratch& scratch) {
  scratch.write(
      "bed.csv",
      "x,y,z,radius,vx,temperature\n0.0040,0.005,0.005,0.001,0.2,400\n0.0062,0.005,0.005,0.001,0,300\n");
  return scratch
      .write("scene.toml", R"([scene]
end_time_s = 0.004
[material]
density_kg_m3 = 2500
specific_heat_J_kgK = 1
conductivity_W_mK = 3e6
youngs_modulus_Pa = 5e6
poisson_ratio = 0.3
restitution = 0.5
friction = 0.3
[particles]
file = "bed.csv"
[box]
size_m = [0.01, 0.01, 0.01]
[dem]
step_s = 1e-5
[conduction]
every_steps = 50
[output]
every_s = 0.001
frames_every_s = 0.004
)")
      .string();
}

}  // namespace

// Planted: the state kept after the step that fails (the heats differ); no checkpoint (the frame is missing).
TEST(GranrunRefusal, LeadsOnWithAnotherStep) {
  Scratch scratch;
  const auto scene = sudden_contact(scratch);
  const auto refused = scratch.root / "refused", right = scratch.root / "right";
  const auto first = granrun(scratch, "run " + scene + " -q -o " + refused.string());
  EXPECT_EQ(first.code, 1);
  EXPECT_NE(first.err.find("conduction.every_steps"), std::string::npos) << first.err;
  EXPECT_EQ(last_frame(refused).filename(), "f_000000100.hdf");
  const auto history = content(refused / "history.csv");
  EXPECT_EQ(granrun(scratch, "run " + scene + " -q --resume -o " + refused.string()).code, 1);
  EXPECT_EQ(content(refused / "history.csv"), history);

  const std::string shorter = " --set conduction.every_steps=1 -q -o ";
  const auto again = granrun(scratch, "run " + scene + " --resume" + shorter + refused.string());
  ASSERT_EQ(again.code, 0) << again.err;
  ASSERT_EQ(granrun(scratch, "run " + scene + shorter + right.string()).code, 0);
  // Nothing conducts before the contact: both are the same from there.
  const Bed a = read_frame(last_frame(refused)).bed, b = read_frame(last_frame(right)).bed;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(a.temperature_K[i], 350, 1e-6);
    EXPECT_NEAR(a.temperature_K[i], b.temperature_K[i], 1e-9);
    EXPECT_EQ(a.position_m[i].x, b.position_m[i].x);
  }
  EXPECT_EQ(read_history(refused / "history.csv").at("time_s").size(), 4u);
}

// A signal in the middle of an update that takes a minute. Planted: the update taken to its end (the frame is later).
TEST(GranrunRefusal, SlowUpdatesStopAtOnce) {
  for (const char* source : {"paths", "lines", "embree"}) {
    SCOPED_TRACE(source);
    Scratch scratch;
    const auto scene =
        scratch.write("scene.toml", edited(small_plug, "step_s = 1e-5", "engine = \"none\"")).string();
    const auto folder = scratch.root / "case";
    const std::string kind = std::string("radiation.source=\"") + source + "\"";
    const pid_t child = start_granrun({"run", scene, "-q", "--threads", "1", "-o", folder.string(), "--set",
                                       kind, "--set", "radiation.rays=2e7"});
    for (int k = 0; k < 1000 && !fs::exists(folder / "run.hdf.series"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ASSERT_EQ(kill(child, SIGTERM), 0);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(exit_code(status), 143);
    EXPECT_EQ(last_frame(folder).filename(), "f_000000000.hdf");
    const auto on = granrun(scratch, "run " + scene + " -q --resume --set radiation.rays=1000 --set " + "'" +
                                         kind + "' -o " + folder.string());
    EXPECT_EQ(on.code, 0) << on.err;
  }
}
