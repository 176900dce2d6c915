// Requirement: radiative heats that are held over an interval know what conduction does within it. A sphere that a hot wall warms
// much faster than that does not pass the wall's temperature, and where both are slow the error falls with the square of the
// interval, as it does without conduction.
//
// Planted, seen to fail: emission at the temperature of the start (2.1 K above the wall; first order); the bounds taken from
// the temperatures of the start alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation/simulation.h"
#include "tests/scene_text.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

struct Held {
  double radius_m, overlap_m, floor_K, others_K, first_K, end_s, radiation_s, row_s;
  const char* source;
};

/// Temperatures of one sphere pressed on a floor in a black box, at every row.
std::vector<double> temperatures_K(const Held& s) {
  const TemporaryFolder folder;
  const double size = 6 * s.radius_m;
  folder.write("bed.csv", fmt::format("x,y,z,radius,temperature\n{0},{0},{1},{2},{3}\n", size / 2,
                                      s.radius_m - s.overlap_m, s.radius_m, s.first_K));
  std::string text = fmt::format("[scene]\nend_time_s = {}\n", s.end_s) + scene_text::alumina +
                     "[particles]\nfile = \"bed.csv\"\n" +
                     fmt::format("[box]\nsize_m = [{0}, {0}, {0}]\n", size);
  for (const char* face : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    text += fmt::format("[walls.{}]\nrole = \"isothermal\"\ntemperature_K = {}\n", face,
                        std::string(face) == "z_min" ? s.floor_K : s.others_K);
  text += fmt::format(
      "[dem]\nengine = \"none\"\n[conduction]\nmodulus_exponent = 0.2\n[radiation]\nsource = \"{}\"\nevery_s = {}\n"
      "[output]\nevery_s = {}\n",
      s.source, s.radiation_s, s.row_s);
  const Case c = read_case(folder.write("scene.toml", text), {});
  Simulation simulation(c, 1);
  simulation.start();
  std::vector<double> found;
  while (!simulation.finished()) {
    simulation.advance();
    found.push_back(simulation.bed().temperature_K[0]);
  }
  return found;
}

TEST(ConductionWithRadiation, NoSphereIsWarmerThanTheHottestWall) {
  for (const char* source : {"paths", "lines"}) {
    const auto T = temperatures_K({1e-5, 1e-6, 1500, 1500, 300, 0.02, 0.005, 0.005, source});
    for (const double t : T) EXPECT_LE(t, 1500 * (1 + 1e-9)) << source;
    EXPECT_NEAR(T.back(), 1500, 0.1) << source;
  }
}

TEST(ConductionWithRadiation, NorColderThanTheColdest) {
  const auto T = temperatures_K({1e-5, 1e-6, 300, 300, 1500, 0.02, 0.005, 0.005, "lines"});
  for (const double t : T) EXPECT_GE(t, 300 * (1 - 1e-9));
  EXPECT_NEAR(T.back(), 300, 0.1);
}

TEST(ConductionWithRadiation, AreTogetherOfSecondOrder) {
  const auto end_K = [](double radiation_s) {
    return temperatures_K({1e-3, 2e-5, 300, 1000, 300, 3.2, radiation_s, 0.0125, "lines"}).back();
  };
  const double fine = end_K(0.0125), e1 = end_K(0.4) - fine, e2 = end_K(0.2) - fine, e4 = end_K(0.1) - fine;
  EXPECT_GT(std::abs(e1), 1e-3) << "something to see: " << fine << " K";
  EXPECT_NEAR(std::log2(e1 / e2), 2, 0.3);
  EXPECT_NEAR(std::log2(e2 / e4), 2, 0.3);
}

}  // namespace
}  // namespace granrad
