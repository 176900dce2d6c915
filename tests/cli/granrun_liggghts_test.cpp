// Requirement: granrun runs a scene on LIGGGHTS with the same heat, feed and files as on its own engine, and
// resumes it to the same bits, after a signal and at the end of its wall time too, with MPI in the process; a
// build or scene that LIGGGHTS cannot run is refused with the key that is in
// the way.
#include <signal.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "coupling/simulation/history.h"
#include "dem/io/snapshot.h"
#include "granrun.h"
#include "liggghts_built.h"

using namespace granrad;
using namespace granrad::cli;

TEST(GranrunLiggghts, HeatsAPlugAsTheNativeEngineDoes) {
  if (!liggghts_is_built()) GTEST_SKIP() << "built without LIGGGHTS";
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto ours = scratch.root / "native", theirs = scratch.root / "liggghts";
  const std::string choice = " -q --set dem.engine=liggghts";
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q -o " + ours.string()).code, 0);
  const auto outcome = granrun(scratch, "run " + scene + choice + " -o " + theirs.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const History a = read_history(ours / "history.csv"), b = read_history(theirs / "history.csv");
  for (double defect : b.at("energy_defect")) EXPECT_LE(defect, 1e-10);
  // At first the beds are alike but for the engines' errors; then collisions part them, and the heat of all
  // agrees.
  EXPECT_NEAR(b.at("Q_rad_W").front() / a.at("Q_rad_W").front(), 1, 1e-4);
  EXPECT_NEAR(b.at("Q_sfs_W").front() / a.at("Q_sfs_W").front(), 1, 5e-3);
  const auto rise = [](const History& h) { return h.at("mean_temperature_K").back() - 300; };
  EXPECT_NEAR(rise(b) / rise(a), 1, 0.02);

  const auto resumed = scratch.root / "resumed";
  ASSERT_EQ(
      granrun(scratch, "run " + scene + choice + " -o " + resumed.string() + " --set scene.end_time_s=0.02")
          .code,
      0);
  ASSERT_EQ(granrun(scratch, "run " + scene + choice + " -o " + resumed.string() + " --resume").code, 0);
  expect_same_case(theirs, resumed);
}

// Planted: signals left to the system, which ends the process.
TEST(GranrunLiggghts, SignalsSaveACheckpointThatResumes) {
  if (!liggghts_is_built()) GTEST_SKIP() << "built without LIGGGHTS";
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    SCOPED_TRACE(code);
    Scratch scratch;
    const auto scene = scratch.write("plug.toml", small_plug).string();
    const auto stopped = scratch.root / "stopped", whole = scratch.root / "whole";
    const pid_t child = start_granrun({"run", scene, "-q", "-o", stopped.string(), "--set",
                                       "dem.engine=liggghts", "--set", "scene.end_time_s=100"});
    for (int wait = 0; wait < 1500 && !fs::exists(stopped / "frames" / "f_000000800.hdf"); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status)) << "ended by the signal itself";
    EXPECT_EQ(exit_code(status), code);
    for (const auto& entry : fs::directory_iterator(stopped / "frames"))
      EXPECT_EQ(entry.path().extension(), ".hdf") << entry.path();
    const Snapshot saved = read_frame(last_frame(stopped));
    ASSERT_GE(saved.bed.step, 800);
    EXPECT_EQ(saved.bed.step % 100, 0) << "not a whole heat step";

    const auto end = " -q --set dem.engine=liggghts --set scene.end_time_s=" +
                     std::to_string(static_cast<double>(saved.bed.step + 500) * 1e-5);
    ASSERT_EQ(granrun(scratch, "run " + scene + end + " -o " + stopped.string() + " --resume").code, 0);
    ASSERT_EQ(granrun(scratch, "run " + scene + end + " -o " + whole.string()).code, 0);
    expect_same_case(whole, stopped);
  }
}

// Planted: a stop that saves nothing.
TEST(GranrunLiggghts, WallTimeSavesACheckpointThatResumes) {
  if (!liggghts_is_built()) GTEST_SKIP() << "built without LIGGGHTS";
  Scratch scratch;
  const auto run = "run " + scratch.write("plug.toml", small_plug).string() +
                   " -q --set dem.engine=liggghts --set scene.end_time_s=0.0123 -o ";
  const auto stopped = scratch.root / "stopped", whole = scratch.root / "whole";
  EXPECT_EQ(granrun(scratch, run + stopped.string() + " --walltime 0:0:0").code, 75);
  EXPECT_EQ(last_frame(stopped).filename(), "f_000000100.hdf");
  EXPECT_EQ(granrun(scratch, run + stopped.string() + " --walltime 0:0:0 --resume").code, 75);
  EXPECT_EQ(last_frame(stopped).filename(), "f_000000200.hdf");
  ASSERT_EQ(granrun(scratch, run + stopped.string() + " --resume").code, 0);
  ASSERT_EQ(granrun(scratch, run + whole.string()).code, 0);
  expect_same_case(whole, stopped);
}

TEST(GranrunLiggghts, RefusesWithAdvice) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto outcome =
      granrun(scratch, "check " + scene + " --set dem.engine=liggghts --set material.restitution=0.04");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("dem.engine = \"liggghts\""), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("use \"native\""), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("restitution = 0.04") != std::string::npos, liggghts_is_built()) << outcome.err;
}
