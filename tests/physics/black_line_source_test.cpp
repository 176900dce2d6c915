// Requirement: between black surfaces a moving bed is heated along the lines themselves, by the same heats as through
// exchange areas, with a true error of the wall heat; anything grey or re-radiating goes through exchange areas.
// Planted, seen to fail: the emissive powers of the last update (HeatsOfTheMatrix); the scatter of one replicate for that of
// their mean (ErrorOfTheWallHeatIsTrue); adiabatic walls taken as black (GreyGoesToTheMatrix).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "coupling/heat/radiosity_source.h"
#include "raytrace/lines/black_line_source.h"
#include "tests/line_cases.h"

namespace granrad {
namespace {

const Enclosure& bed() {
  static const Box box{{0, 0, 0}, {0.005, 0.004, 0.006}};
  static const Enclosure enclosure = packed(box, equal_radii(box, 0.4, 4e-4));
  return enclosure;
}

RadiativeState state(WallRole other_walls, double sphere_K = 300) {
  RadiativeState s;
  for (std::size_t i = 0; i < bed().sphere_count(); ++i) s.add(sphere_K + static_cast<double>(i % 7), 1);
  for (const Wall& wall : bed().walls) wall.name[0] == 'y' ? s.add(1000, 1) : s.add(400, 1, other_walls);
  s.add(300, 1, WallRole::open);
  return s;
}

LineOptions lines(std::uint64_t seed = 1) {
  LineOptions o;
  o.directions = 60;
  o.lines_per_disc = 6;
  o.seed = seed;
  o.threads = 1;
  return o;
}

std::unique_ptr<ExchangeSource> by_matrix(std::uint64_t seed = 1) {
  return std::make_unique<RadiositySource>(
      [seed](const Enclosure& enclosure, std::uint64_t key) {
        LineOptions o = lines(seed);
        o.seed += key;
        return sweep_exchange_areas(enclosure, o);
      },
      Closure::reciprocal);
}

TEST(BlackLineSource, HeatsOfTheMatrix) {
  BlackLineSource source(lines(), by_matrix());
  source.net_heat(bed(), state(WallRole::isothermal, 600), 0);
  const auto heat = source.net_heat(bed(), state(WallRole::isothermal), 1);
  const auto matrix = by_matrix()->net_heat(bed(), state(WallRole::isothermal), 1);
  EXPECT_EQ(heat.closure_correction, 0) << "nothing was closed";
  EXPECT_GT(heat.rays, 0);
  double squares = 0, all = 0;
  for (std::size_t i = 0; i < bed().sphere_count(); ++i) {
    squares += std::pow(heat.heat_W[i] - matrix.heat_W[i], 2);
    all += std::pow(matrix.heat_W[i], 2);
  }
  EXPECT_LT(std::sqrt(squares / all), matrix.closure_correction)
      << "the same lines: they differ by what closing did";
  EXPECT_NEAR(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0), 0,
              1e-12 * heat.isothermal_wall_heat_W);
  EXPECT_NEAR(heat.isothermal_wall_heat_W / matrix.isothermal_wall_heat_W, 1, 0.005);
}

TEST(BlackLineSource, ErrorOfTheWallHeatIsTrue) {
  constexpr int runs = 40;
  double sum = 0, squares = 0, claimed = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    BlackLineSource source(lines(static_cast<std::uint64_t>(1000 * seed)), nullptr);
    const auto heat = source.net_heat(bed(), state(WallRole::isothermal), 0);
    sum += heat.isothermal_wall_heat_W;
    squares += std::pow(heat.isothermal_wall_heat_W, 2);
    claimed += std::pow(heat.isothermal_wall_heat_error_W, 2) / runs;
  }
  const double found = (squares - sum * sum / runs) / (runs - 1);
  EXPECT_NEAR(std::sqrt(claimed / found), 1, 0.3) << "scatter of 40 runs: 11 %, of their 3 degrees each: 7 %";
}

TEST(BlackLineSource, GreyGoesToTheMatrix) {
  BlackLineSource source(lines(), by_matrix());
  const auto heat = source.net_heat(bed(), state(WallRole::adiabatic), 0);
  EXPECT_EQ(heat.heat_W, by_matrix()->net_heat(bed(), state(WallRole::adiabatic), 0).heat_W);
}

}  // namespace
}  // namespace granrad
