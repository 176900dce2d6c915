// Requirement: a wall that is taken away gives no more heat, whatever moves the particles: nothing, or a recording of a bed
// that rests. Until then it gives G (T_w - T) for each second, as if it stayed.
//
// Planted, seen: the contacts of a frozen bed found once and for all (the floor heats to the end: twice the heat), the same
// of a recorded bed. Both fail here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupling/simulation/simulation.h"
#include "tests/scene_text.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

constexpr double end_s = 1e-3;

std::string dump(int step) {
  return fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 0.004\n0 0.004\n"
      "0 0.004\nITEM: ATOMS id type x y z radius temp\n1 1 0.002 0.002 0.000999 0.001 300\n",
      step);
}

/// K by which a sphere on a floor at 1000 K is warmer after `end_s`; frames on the way if `stop`.
double warmed_K(const std::string& engine, const std::string& opens, bool stop = false) {
  const TemporaryFolder folder;
  folder.write("bed.csv", "x,y,z,radius,temperature\n0.002,0.002,0.000999,0.001,300\n");
  for (const int step : {0, 1000}) folder.write(fmt::format("flow.{}.dump", step), dump(step));
  const bool replay = engine == "replay";
  const std::string text =
      fmt::format("[scene]\nend_time_s = {}\n", end_s) + scene_text::alumina + "[gas]\n[particles]\n" +
      (replay ? "" : "file = \"bed.csv\"\n") + "[box]\nsize_m = [0.004, 0.004, 0.004]\n" +
      "[walls]\nx_min = {role = \"adiabatic\"}\nx_max = {role = \"adiabatic\"}\ny_min = {role = \"adiabatic\"}\n"
      "y_max = {role = \"adiabatic\"}\nz_max = {role = \"adiabatic\"}\n"
      "[walls.z_min]\nrole = \"isothermal\"\ntemperature_K = 1000\n" +
      opens + "[dem]\nengine = \"" + engine + "\"\n" +
      (replay ? "files = \"flow.*.dump\"\nstep_s = 1e-6\n" : "") + "[output]\nevery_s = 1e-5\n";
  const Case c = read_case(folder.write("scene.toml", text), {});
  auto simulation = std::make_unique<Simulation>(c, 1);
  simulation->start();
  while (!simulation->finished()) {
    simulation->advance();
    if (!stop) continue;
    simulation->write_checkpoint(folder / "now.hdf");
    simulation = std::make_unique<Simulation>(c, 1);
    EXPECT_TRUE(simulation->resume(read_frame(folder / "now.hdf")));
  }
  return simulation->bed().temperature_K[0] - 300;
}

TEST(ShutterHeat, AFloorThatIsTakenAwayHeatsNoMore) {
  for (const char* engine : {"none", "replay"}) {
    const double always = warmed_K(engine, "");
    ASSERT_GT(always, 1e-3);
    EXPECT_NEAR(warmed_K(engine, "opens_at_s = 0.000405\n") / always, 0.4, 0.01) << engine;
    EXPECT_EQ(warmed_K(engine, "opens_at_s = 0.002\n"), always) << engine;
    EXPECT_EQ(warmed_K(engine, "opens_at_s = 0\n"), 0) << engine;
  }
}

TEST(ShutterHeat, AStopChangesNothing) {
  EXPECT_EQ(warmed_K("none", "opens_at_s = 0.000405\n", true), warmed_K("none", "opens_at_s = 0.000405\n"));
}

}  // namespace
}  // namespace granrad
