// Requirement: on several ranks a trace and a run end with the bits of one process; only the first rank writes and
// speaks; the wall time, a signal, an error and the death of a rank end all of them, with the right exit code and a case
// that resumes exactly.
// Planted, each seen by the test named: a piece of walks counted by two ranks (TheLastFrameDoesNotDependOnRanks), a
// direction of lines counted by two ranks (AViewFactorFileDoesNotDependOnRanks), a signal that only its own rank obeys
// (ASignalToOneRankStopsAll).
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "mpirun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

class Ranks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!ranks_are_built()) GTEST_SKIP() << "built without MPI, or no mpirun";
  }
  Scratch scratch;
};
using RanksLong = Ranks;

/// Spheres of two sizes on a lattice, somewhat out of place.
fs::path write_bed(const Scratch& scratch) {
  std::string text = "x,y,z,radius\n";
  for (int k = 0; k < 216; ++k) {
    const double shift = 8e-5 * std::sin(3.0 * k);
    text += std::to_string(1e-3 * (k % 6 + 0.5) + shift) + "," +
            std::to_string(1e-3 * (k / 6 % 6 + 0.5) - shift) + "," +
            std::to_string(1e-3 * (k / 36 + 0.5) + shift) + "," + (k % 3 ? "3.5e-4" : "2.5e-4") + "\n";
  }
  return scratch.write("bed.csv", text);
}

std::string trace_line(const fs::path& bed, const std::string& how, const fs::path& file) {
  return "trace " + bed.string() + " --box 0.006,0.006,0.006 -q " + how + " -o " + file.string();
}

/// A file from one process and from each number of ranks is the same, byte for byte.
void expect_one_file(const Scratch& scratch, const std::string& how, const std::vector<int>& ranks,
                     const std::vector<int>& threads) {
  SCOPED_TRACE(how);
  const auto bed = write_bed(scratch), alone = scratch.root / "alone.h5", shared = scratch.root / "shared.h5";
  ASSERT_EQ(run(scratch, "vfgen", trace_line(bed, how, alone)).code, 0);
  for (const int r : ranks)
    for (const int t : threads) {
      const auto outcome =
          run_on_ranks(scratch, r, "vfgen", trace_line(bed, how, shared) + " --threads " + std::to_string(t));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_TRUE(content(alone) == content(shared)) << r << " ranks, " << t << " threads";
      fs::remove(shared);
    }
}

std::string plug_line(const fs::path& scene, const fs::path& folder, const std::string& more = "") {
  return "run " + scene.string() + " -q --threads 1 --set scene.end_time_s=0.008 -o " + folder.string() +
         more;
}

void expect_one_case(const Scratch& scratch, const std::string& more, const std::vector<int>& ranks) {
  SCOPED_TRACE(more);
  const auto scene = scratch.write("plug.toml", small_plug), alone = scratch.root / "alone";
  fs::remove_all(alone);
  ASSERT_EQ(granrun(scratch, plug_line(scene, alone, more)).code, 0);
  for (const int r : ranks) {
    SCOPED_TRACE(r);
    const auto shared = scratch.root / "shared";
    fs::remove_all(shared);
    const auto outcome = run_on_ranks(scratch, r, "granrun", plug_line(scene, shared, more));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    expect_same_case(alone, shared);
    EXPECT_EQ(content(alone / "walls.csv"), content(shared / "walls.csv"));
  }
}

/// Goes on from the last frame on two ranks, and compares with one process that never stopped.
void expect_exact_resume(const Scratch& scratch, const fs::path& scene, const fs::path& stopped) {
  const std::string name = last_frame(stopped).filename();
  const auto end = " --set scene.end_time_s=" + std::to_string((std::stod(name.substr(2, 9)) + 300) * 1e-5);
  const auto whole = scratch.root / "whole";
  const auto outcome = run_on_ranks(
      scratch, 2, "granrun", "run " + scene.string() + " -q -o " + stopped.string() + end + " --resume");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(granrun(scratch, "run " + scene.string() + " -q -o " + whole.string() + end).code, 0);
  expect_same_case(whole, stopped);
}

TEST_F(Ranks, CollectAndExchange) {
  for (const int r : {2, 5}) {
    const auto outcome = run_on_ranks(scratch, r, "ranks_probe", "collect");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, std::to_string(r) + " ranks\n");
  }
}

TEST_F(Ranks, ARankThatFailsAloneSaysSoAndEndsAll) {
  const auto outcome = run_on_ranks(scratch, 3, "ranks_probe", "alone");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(times_said(outcome.err, "rank 1: the disk of this node is full"), 1) << outcome.err;
}

TEST_F(Ranks, WhatTheFirstRankFailsAtIsSaidOnce) {
  const auto outcome = run_on_ranks(scratch, 3, "ranks_probe", "first");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(times_said(outcome.err, "only the first rank writes"), 1) << outcome.err;
}

TEST_F(Ranks, DifferentStatesAreRefused) {
  const auto outcome = run_on_ranks(scratch, 2, "ranks_probe", "differ");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(times_said(outcome.err, "do not agree on their number"), 1) << outcome.err;
}

TEST_F(Ranks, AViewFactorFileDoesNotDependOnRanks) {
  expect_one_file(scratch, "--rays 200", {3}, {2});
  expect_one_file(scratch, "--method lines --rays 200", {3}, {2});
}

TEST_F(RanksLong, AViewFactorFileDoesNotDependOnRanksLong) {
  for (const char* how : {"--rays 200", "--error 0.02", "--emissivity 0.5 --rays 200",
                          "--method lines --rays 200", "--method lines --error 0.01",
                          "--rays 2000 --memory 1MiB", "--method lines --rays 2000 --memory 1MiB"})
    expect_one_file(scratch, how, {1, 2, 3, 5, 8}, {1, 2});
}

TEST_F(Ranks, TheLastFrameDoesNotDependOnRanks) {
  expect_one_case(scratch, "", {3});
}

TEST_F(RanksLong, TheLastFrameDoesNotDependOnRanksLong) {
  for (const char* source : {"paths", "lines", "embree", "shading"})
    expect_one_case(scratch, std::string(" --set radiation.rays=200 --set radiation.source=") + source,
                    {1, 2, 3, 5, 8});
  expect_one_case(scratch, " --set radiation.source=lines --set radiation.rays=100 --set radiation.order=1",
                  {2});
  expect_one_case(scratch, " --unset radiation.rays --set radiation.error=0.05", {3});
  expect_one_case(scratch, " --set radiation.source=none", {2});
}

// Ranks share the search of a recorded flow's contacts.
TEST_F(Ranks, HeatOnARecordedFlowDoesNotDependOnRanks) {
  const auto flow = scratch.root / "flow";
  const auto scene = scratch.write("plug.toml", small_plug);
  ASSERT_EQ(granrun(scratch, plug_line(scene, flow, " --set output.frames_every_s=0.002")).code, 0);
  std::string text = small_plug;
  const auto feed = text.find("[feed]");
  text.erase(feed, text.find("[radiation]") - feed);
  text = edited(text, "diameter_m = \"0.8 mm\"\ntemperature_K = 300\n", "temperature_K = 300\n");
  text += "[dem]\nengine = \"replay\"\nfiles = \"flow/frames/f_*.hdf\"\n";
  const auto replayed = scratch.write("replay.toml", text), alone = scratch.root / "alone";
  const std::string ends = " --set walls.z_min.contact=false --set walls.z_max.contact=false";
  ASSERT_EQ(granrun(scratch, plug_line(replayed, alone, ends)).code, 0);
  const auto shared = scratch.root / "shared";
  const auto outcome = run_on_ranks(scratch, 3, "granrun", plug_line(replayed, shared, ends));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_same_case(alone, shared);
}

TEST_F(Ranks, TheWallTimeStopsAllAndAnotherNumberOfRanksGoesOn) {
  const auto scene = scratch.write("plug.toml", small_plug), stopped = scratch.root / "stopped";
  EXPECT_EQ(run_on_ranks(scratch, 3, "granrun", plug_line(scene, stopped, " --walltime 0:0:0")).code, 75);
  EXPECT_EQ(last_frame(stopped).filename(), "f_000000100.hdf");
  expect_exact_resume(scratch, scene, stopped);
}

TEST_F(Ranks, ASignalToOneRankStopsAll) {
  const auto scene = scratch.write("plug.toml", small_plug), stopped = scratch.root / "stopped";
  EXPECT_EQ(stopped_by(scratch, scene, stopped, SIGINT), 130);
  const auto said = content(scratch.root / "stopped.txt");
  EXPECT_EQ(times_said(said, "ABORT"), 0) << said;
  expect_exact_resume(scratch, scene, stopped);
}

TEST_F(RanksLong, TheDeathOfARankEndsTheOthersLong) {
  const auto scene = scratch.write("plug.toml", small_plug), stopped = scratch.root / "stopped";
  EXPECT_NE(stopped_by(scratch, scene, stopped, SIGKILL), 0);
  for (int wait = 0; wait < 200 && !ranks_on(stopped).empty(); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(ranks_on(stopped).empty());
  expect_exact_resume(scratch, scene, stopped);
}

TEST_F(Ranks, WrongInputAndOtherCommandsAreRefusedOnce) {
  const auto scene = scratch.write("plug.toml", small_plug);
  const auto wrong = run_on_ranks(scratch, 2, "granrun",
                                  plug_line(scene, scratch.root / "case", " --set particles.diameter_m=-1"));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_EQ(times_said(wrong.err, "must be > 0"), 1) << wrong.err;
  EXPECT_FALSE(fs::exists(scratch.root / "case"));
  const auto other = run_on_ranks(scratch, 2, "granrun", "report " + scratch.root.string());
  EXPECT_EQ(other.code, 2);
  EXPECT_EQ(times_said(other.err, "granrun report runs in one process"), 1) << other.err;
}

}  // namespace
