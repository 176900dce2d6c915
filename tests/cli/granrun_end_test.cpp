// Requirement: a run ends at the end asked for, its last heat step cut short where it must be, with the
// energy closed and the same bits after a stop; a longer run goes on as if that end had never been. An end
// between two steps is moved to the nearest one, and said so.
#include "coupling/simulation/history.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

/// Heat steps of 1 ms in a moving bed, of 2 ms in a frozen one.
struct Kind {
  const char* name;
  std::string scene;
  const char* last_whole_frame;
  const char* end_frame;  ///< of a run that ends at 12.3 ms
};

std::vector<Kind> kinds() {
  return {{"moving", small_plug, "f_000001200.hdf", "f_000001230.hdf"},
          {"frozen", edited(small_plug, "step_s = 1e-5", "engine = \"none\""), "f_000006000.hdf",
           "f_000006150.hdf"}};
}

}  // namespace

TEST(GranrunEnd, CutsTheLastHeatStep) {
  for (const auto& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    Scratch scratch;
    const auto run = "run " + scratch.write("plug.toml", kind.scene).string() +
                     " -q --threads 1 --set radiation.rays=20000 -o ";
    const std::string short_end = " --set scene.end_time_s=0.0123";
    const auto folder = scratch.root / "short", stopped = scratch.root / "stopped";
    const auto whole = scratch.root / "whole";
    ASSERT_EQ(granrun(scratch, run + folder.string() + short_end).code, 0);
    const History history = read_history(folder / "history.csv");
    EXPECT_DOUBLE_EQ(history.at("time_s").back(), 0.0123);
    for (double defect : history.at("energy_defect")) EXPECT_LE(defect, 1e-10);
    EXPECT_EQ(last_frame(folder).filename(), kind.end_frame);
    EXPECT_NE(content(folder / "run.hdf.series").find("0.0123"), std::string::npos);
    // 20 000 walks: with 500 the heat of one update is off by a half. Planted: the heat of a whole step in the cut one,
    // 0.08 and 0.17 instead of 0.025.
    const auto rise = [&](std::size_t row) { return history.at("mean_temperature_K")[row] - 300; };
    EXPECT_NEAR(rise(3) / rise(2) - 1, 0.3 / 12, 0.01);

    ASSERT_EQ(granrun(scratch, run + stopped.string() + short_end + " --walltime 0:0:0").code, 75);
    ASSERT_EQ(granrun(scratch, run + stopped.string() + short_end + " --resume").code, 0);
    expect_same_case(folder, stopped);

    ASSERT_EQ(granrun(scratch, run + whole.string()).code, 0);
    EXPECT_TRUE(fs::exists(folder / "frames" / kind.last_whole_frame));
    ASSERT_EQ(granrun(scratch, run + folder.string() + " --resume").code, 0);
    expect_same_case(whole, folder);
  }
}

TEST(GranrunEnd, MovesAnEndBetweenTwoStepsAndSaysSo) {
  for (const auto& [kind, ends] : {std::pair{kinds()[0], "0.01235"}, std::pair{kinds()[1], "0.012346"}}) {
    SCOPED_TRACE(kind.name);
    Scratch scratch;
    const auto scene = scratch.write("plug.toml", kind.scene).string() + " --set scene.end_time_s=0.0123456";
    const auto folder = scratch.root / "case";
    const auto outcome = granrun(scratch, "run " + scene + " -o " + folder.string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("scene.end_time_s = 0.0123456 s (not a whole number of steps of "),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find(std::string("the run ends at ") + ends + " s"), std::string::npos)
        << outcome.err;
    EXPECT_DOUBLE_EQ(read_history(folder / "history.csv").at("time_s").back(), std::stod(ends));
    const auto checked = granrun(scratch, "check " + scene);
    EXPECT_NE(checked.out.find(std::string("the run ends at ") + ends), std::string::npos) << checked.out;
    EXPECT_NE(checked.out.find("the last one cut short"), std::string::npos) << checked.out;
  }
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto checked = granrun(scratch, "check " + scene + " --set scene.end_time_s=20.000004");
  EXPECT_NE(checked.out.find("the run ends at 20 s"), std::string::npos) << checked.out;
  EXPECT_EQ(
      granrun(scratch, "run " + scene + " -o " + (scratch.root / "case").string()).err.find("the run ends"),
      std::string::npos);
}

TEST(GranrunEnd, ValidationStopsThereToo) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto outcome =
      granrun(scratch, "validate " + scene +
                           " -q --set scene.end_time_s=0.0123447 --set validate.times_s=[0.0123447] -o " +
                           (scratch.root / "v").string());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(content(scratch.root / "v" / "validation.csv").find(",0.012344"), std::string::npos);
}
