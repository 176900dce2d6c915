// Requirement: a moving bed runs with its own table from the empty channel through filling and opening to steady flow, and
// h_rad is within 3 % of traced paths where surfaces are black. Grey ones have the bias of one radiosity for each surface on
// top (+13 to +18 % at emissivity 0.4 in dense beds): printed and held to what it is known to be.
// Planted error: walls that see each other as through an empty box (h_rad -26 %). F_pw read at half the distance is not seen
// here (+2.8 %): closure gives the walls' rows what they miss.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation/simulation.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

constexpr double end_s = 0.9, steady_from_s = 0.6;  // the outlet of moving_bed_short.toml opens at 0.4 s

struct Bed4000 {
  double h_rad = 0, first_fraction = 1, last_fraction = 0;
};

Bed4000 run(const std::string& source, double emissivity) {
  const std::string data = source_dir() + "/data/";
  std::vector<std::string> set = {"scene.end_time_s=" + std::to_string(end_s),
                                  "radiation.source=" + source,
                                  "material.emissivity=" + std::to_string(emissivity),
                                  "walls.y_min.emissivity=" + std::to_string(emissivity),
                                  "walls.y_max.emissivity=" + std::to_string(emissivity),
                                  "output.every_s=0.05",
                                  "output.frames_every_s=0.9"};
  if (source == "correlation")
    set.push_back("radiation.table=" + data + "correlations/granrad_moving_bed.toml");
  const Case c = read_case(data + "scenes/moving_bed_short.toml", set);
  Simulation simulation(c, 0);
  simulation.start();
  Bed4000 result;
  double rows = 0;
  while (!simulation.finished()) {
    simulation.advance();
    if (!simulation.plan().row_at(simulation.tick())) continue;
    const HistoryRow row = simulation.record().row;
    result.first_fraction = std::min(result.first_fraction, row["solid_fraction"]);
    result.last_fraction = row["solid_fraction"];
    if (row["time_s"] > steady_from_s * (1 + 1e-9)) result.h_rad += row["h_rad_W_m2K"], ++rows;
  }
  result.h_rad /= rows;
  return result;
}

TEST(MovingBedTable, FromEmptyToSteadyLong) {
  const Bed4000 table = run("correlation", 1), paths = run("paths", 1);
  EXPECT_LT(table.first_fraction, 0.2);
  EXPECT_GT(table.last_fraction, 0.52);
  const double black = table.h_rad / paths.h_rad - 1;
  const double grey = run("correlation", 0.4).h_rad / run("paths", 0.4).h_rad - 1;
  std::printf("h_rad of the table against paths: emissivity 1 %+.2f %% (%.2f, %.2f W/m2K), 0.4 %+.1f %%\n",
              100 * black, table.h_rad, paths.h_rad, 100 * grey);
  EXPECT_NEAR(black, 0, 0.03);
  EXPECT_GT(grey, 0.05);
  EXPECT_LT(grey, 0.20);
}

}  // namespace
}  // namespace granrad
