// Requirement: a wall whose temperature is given over time heats what touches it and what it radiates to as the energy
// balance of a sphere says: m c dT/dt = G (T_w(t) - T), and m c dT/dt = A sigma (T_w(t)^4 - T^4) in a black box. A run
// that is stopped on its way ends with the same bits.
//
// Planted, seen: the temperature at the start of each heat step (.9 K of 96, .18 K of 11), the mean of a heat step, not of the interval, for radiation
// (.18 K), courses looked for in the frame on resume.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation/simulation.h"
#include "dem/base/constants.h"
#include "tests/scene_text.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

constexpr double end_s = 20, start_K = 300, rise_K_s = 10, pause_s = 5;

const std::string ramp = "times_s = [5, 25]\ntemperatures_K = [300, 500]\n";

double ramp_K(double t_s) {
  return start_K + rise_K_s * std::max(0.0, t_s - pause_s);
}

std::string scene(const std::string& walls, const std::string& heat) {
  return fmt::format("[scene]\nend_time_s = {}\n", end_s) + scene_text::alumina + heat +
         "[particles]\nfile = \"bed.csv\"\n[box]\nsize_m = [0.004, 0.004, 0.004]\n" + walls +
         "[dem]\nengine = \"none\"\n[output]\nevery_s = 0.2\n";
}

struct Outcome {
  double temperature_K, wall_K, defect;
};

Outcome run(const std::string& text, const char* z, bool stop = false) {
  const TemporaryFolder folder;
  folder.write("bed.csv", fmt::format("x,y,z,radius,temperature\n0.002,0.002,{},0.001,{}\n", z, start_K));
  const Case c = read_case(folder.write("scene.toml", text), {});
  auto simulation = std::make_unique<Simulation>(c, 1);
  simulation->start();
  int steps = 0;
  while (!simulation->finished()) {
    simulation->advance();
    if (!stop || ++steps % 25 != 0) continue;
    simulation->write_checkpoint(folder / "now.hdf");
    simulation = std::make_unique<Simulation>(c, 1);
    EXPECT_TRUE(simulation->resume(read_frame(folder / "now.hdf")));
  }
  const Bed& bed = simulation->bed();
  return {bed.temperature_K[0], bed.walls[4].temperature_K,
          simulation->heat().ledger().relative_defect(bed, 0, 0)};
}

std::string on_a_floor(const std::string& temperature) {
  std::string walls;
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_max"})
    walls += fmt::format("[walls.{}]\nrole = \"adiabatic\"\n", name);
  return scene(walls + "[walls.z_min]\nrole = \"isothermal\"\n" + temperature, "[gas]\n");
}

TEST(WallCourse, ASphereOnAFloorFollowsItsRamp) {
  const double hot_K = 1000;
  const double steady_K =
      run(on_a_floor(fmt::format("temperature_K = {}\n", hot_K)), "0.000999").temperature_K;
  const double tau_s = -end_s / std::log((hot_K - steady_K) / (hot_K - start_K));
  ASSERT_GT(tau_s, 1);
  ASSERT_LT(tau_s, 2 * end_s);
  const double t_s = end_s - pause_s;
  const Outcome ours = run(on_a_floor(ramp), "0.000999");
  const double expected_K = start_K + rise_K_s * (t_s - tau_s * (1 - std::exp(-t_s / tau_s)));
  EXPECT_NEAR(ours.temperature_K, expected_K, 1e-3 * (expected_K - start_K));
  EXPECT_DOUBLE_EQ(ours.wall_K, ramp_K(end_s));
  EXPECT_LT(ours.defect, 1e-9);
  EXPECT_EQ(run(on_a_floor(ramp), "0.000999", true).temperature_K, ours.temperature_K);
}

std::string in_a_black_box(const std::string& temperature) {
  std::string walls;
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    walls += fmt::format("[walls.{}]\nrole = \"isothermal\"\nemissivity = 1\n", name) + temperature;
  return scene(walls,
               "[conduction]\nsolid = false\n[radiation]\nsource = \"embree\"\nrays = 20\nevery_s = 0.2\n");
}

TEST(WallCourse, ASphereInABlackBoxFollowsItsRamp) {
  const TemporaryFolder folder;
  const Case c = read_case(
      folder.write("scene.toml",
                   [&] {
                     folder.write("bed.csv", "x,y,z,radius,temperature\n0.002,0.002,0.002,0.001,300\n");
                     return in_a_black_box(ramp);
                   }()),
      {});
  const Material& solid = c.flow.materials[0];
  const double area_m2 = 4e-6 * pi,
               heat_capacity_J_K = solid.density_kg_m3 * solid.specific_heat_J_kgK * 4e-9 / 3 * pi;
  const auto slope = [&](double t_s, double T) {
    return solid.emissivity * area_m2 * stefan_boltzmann * (std::pow(ramp_K(t_s), 4) - std::pow(T, 4)) /
           heat_capacity_J_K;
  };
  double expected_K = start_K;
  const int steps = 4000;
  for (int k = 0; k < steps; ++k) {
    const double dt = end_s / steps, t = k * dt, a = slope(t, expected_K),
                 b = slope(t + dt / 2, expected_K + dt / 2 * a),
                 d = slope(t + dt / 2, expected_K + dt / 2 * b), e = slope(t + dt, expected_K + dt * d);
    expected_K += dt / 6 * (a + 2 * b + 2 * d + e);
  }
  const Outcome ours = run(in_a_black_box(ramp), "0.002");
  ASSERT_GT(expected_K, start_K + 3);
  EXPECT_NEAR(ours.temperature_K, expected_K, 1e-3 * (expected_K - start_K));
  EXPECT_LT(ours.defect, 1e-9);
  EXPECT_EQ(run(in_a_black_box(ramp), "0.002", true).temperature_K, ours.temperature_K);
}

TEST(WallCourse, TheMeanIsExact) {
  const TemperatureCourse course{{1, 3, 4}, {300, 500, 400}};
  EXPECT_EQ(course.at(0), 300);
  EXPECT_EQ(course.at(2), 400);
  EXPECT_EQ(course.at(9), 400);
  EXPECT_DOUBLE_EQ(course.mean(0, 5), (300 + 2 * 400 + 450 + 400) / 5.0);
  EXPECT_DOUBLE_EQ(course.mean(1.5, 2.5), 400);
}

}  // namespace
}  // namespace granrad
