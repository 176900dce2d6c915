// Requirement: granrun runs a scene on LIGGGHTS with the same heat, feed and files as on its own engine, and
// resumes it to the same bits; a build or scene that LIGGGHTS cannot run is refused with the key that is in
// the way.
#include "coupling/history.h"
#include "dem/engine_liggghts.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

bool is_built() {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].restitution = 1;
  return liggghts_problems(scene).empty();
}

}  // namespace

TEST(GranrunLiggghts, HeatsAPlugAsTheNativeEngineDoes) {
  if (!is_built()) GTEST_SKIP() << "built without LIGGGHTS";
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
  EXPECT_TRUE(content(last_frame(theirs)) == content(last_frame(resumed)));
  EXPECT_EQ(content(theirs / "history.csv"), content(resumed / "history.csv"));
}

TEST(GranrunLiggghts, RefusesWithAdvice) {
  Scratch scratch;
  const auto scene = scratch.write("plug.toml", small_plug).string();
  const auto outcome =
      granrun(scratch, "check " + scene + " --set dem.engine=liggghts --set material.restitution=0.04");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("dem.engine = \"liggghts\""), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("use \"native\""), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("restitution = 0.04") != std::string::npos, is_built()) << outcome.err;
}
