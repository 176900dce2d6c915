// Requirement: a case is not resumed with another engine, and the advice says how to go on; a new case that
// starts from a frame of it goes on with the other engine as with the first: places, speeds, temperatures and
// the springs of contacts are taken over.
#include <algorithm>

#include "dem/io/snapshot.h"
#include "granrun.h"
#include "liggghts_built.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

constexpr double radius_m = 4e-4;

/// Sixty spheres that fall into the tilted corner of a box and rest there on their friction.
std::string pile(const std::string& file) {
  return R"([scene]
name = "pile"
end_time_s = 0.3
gravity_m_s2 = [2, 0, -9.6]
)" + scene_text::alumina +
         R"([particles]
diameter_m = "0.8 mm"
temperature_K = 300
file = ")" +
         file + R"("
[box]
size_m = [0.004, 0.003, 0.006]
)" + scene_text::walls({{"z_min", 400}}) +
         R"([dem]
step_s = 1e-5
[output]
every_s = 0.01
frames_every_s = 0.1
)";
}

/// A loose lattice, every row shifted a little.
std::string loose_spheres() {
  std::stringstream rows;
  rows << "x,y,z,radius\n";
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        rows << 5e-4 + 9.5e-4 * i + 2e-5 * ((3 * j + 2 * k) % 5) << ','
             << 5e-4 + 9.5e-4 * j + 2e-5 * ((2 * i + k) % 5) << ',' << 5e-4 + 9e-4 * k << ',' << radius_m
             << '\n';
  return rows.str();
}

/// Largest distance between the particles of two beds, in radii.
double apart(const Bed& a, const Bed& b) {
  EXPECT_EQ(a.id, b.id);
  double most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, norm(a.position_m[i] - b.position_m[i]) / radius_m);
  return most;
}

Bed last_bed(const fs::path& folder) {
  return read_frame(last_frame(folder)).bed;
}

}  // namespace

TEST(GranrunEngineChange, IsRefusedOnResumeWithAdvice) {
  if (!liggghts_is_built()) GTEST_SKIP() << "built without LIGGGHTS";
  for (const auto& [first, second] : {std::pair{"native", "liggghts"}, std::pair{"liggghts", "native"}}) {
    Scratch scratch;
    const auto run = "run " + scratch.write("plug.toml", small_plug).string() + " -q --threads 1 -o " +
                     (scratch.root / "case").string() + " --set dem.engine=";
    ASSERT_EQ(granrun(scratch, run + first + " --set scene.end_time_s=0.004").code, 0);
    const auto before = content(last_frame(scratch.root / "case"));
    const auto outcome = granrun(scratch, run + second + " --resume");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("scene differs"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("[particles] file = a frame of this case"), std::string::npos) << outcome.err;
    EXPECT_EQ(content(last_frame(scratch.root / "case")), before);
    EXPECT_EQ(granrun(scratch, run + first + " --resume").code, 0);
  }
}

// Planted: no springs taken over; none of walls; the temperature of the scene instead of the frame's.
TEST(GranrunEngineChange, ANewCaseFromAFrameGoesOnWithItsSprings) {
  if (!liggghts_is_built()) GTEST_SKIP() << "built without LIGGGHTS";
  for (const auto& [first, second] : {std::pair{"native", "liggghts"}, std::pair{"liggghts", "native"}}) {
    SCOPED_TRACE(first);
    Scratch scratch;
    scratch.write("loose.csv", loose_spheres());
    const auto scene = scratch.write("pile.toml", pile("loose.csv")).string();
    const auto settled = scratch.root / "settled";
    ASSERT_EQ(granrun(scratch, "run " + scene + " -q --threads 1 --set dem.engine=" + first + " -o " +
                                   settled.string())
                  .code,
              0);
    const Bed rest = last_bed(settled);
    ASSERT_GT(rest.contacts.size(), 100u);

    const auto go_on = [&](const std::string& name, const std::string& engine, const std::string& from) {
      const auto folder = scratch.root / name;
      const auto next = scratch.write(name + ".toml", pile(from)).string();
      const auto outcome = granrun(
          scratch, "run " + next + " -q --threads 1 --set scene.end_time_s=0.01 --set dem.engine=" + engine +
                       " -o " + folder.string());
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      return last_bed(folder);
    };
    const auto frame = last_frame(settled).string();
    const Bed same = go_on("same", first, frame), other = go_on("other", second, frame);
    Bed bare = rest;
    bare.contacts.clear();
    write_frame(scratch.root / "bare.hdf", bare, {});
    const Bed without = go_on("without", second, (scratch.root / "bare.hdf").string());
    // At rest: 1e-10 radii between the engines, 6e-4 when the springs are lost and the pile settles anew.
    EXPECT_LT(apart(same, other), 1e-7);
    EXPECT_GT(apart(same, without), 1e-5) << "blind to lost springs";
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_GT(same.temperature_K[i], 300);
      EXPECT_NEAR(other.temperature_K[i], same.temperature_K[i], 1e-6);
      EXPECT_NEAR(other.temperature_K[i], rest.temperature_K[i], 1);  // 10 ms of conduction later
    }
  }
}
