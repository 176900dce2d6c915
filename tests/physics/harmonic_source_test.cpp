// Requirement: radiosities resolved over spheres and walls take the one-radiosity bias away order by order,
// conserve energy, leave isothermal enclosures alone and meet the closed forms of grey exchange.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "coupling/heat/harmonic_source.h"
#include "dem/base/error.h"
#include "dem/packing/packing.h"
#include "path_cases.h"

namespace granrad {
namespace {

using namespace path_cases;

LineOptions lines(int directions, std::uint64_t seed = 1) {
  LineOptions o;
  o.directions = directions, o.seed = seed;
  return o;
}

double largest(const std::vector<double>& v) {
  double m = 0;
  for (double x : v) m = std::max(m, std::abs(x));
  return m;
}

// Planted: K_ij transposed in the heats, balance 1e-2.
TEST(HarmonicSource, ConservesEnergyAndLeavesIsothermalBedsAlone) {
  Case c = small_bed(0.4);
  for (const int order : {1, 2, 3}) {
    HarmonicSource source(order, lines(40));
    const auto heat = source.net_heat(c.enclosure, c.state(), 0);
    EXPECT_LT(std::abs(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0)),
              1e-12 * largest(heat.heat_W));
    for (std::size_t w = 0; w < 6; ++w)  // re-radiating walls keep nothing
      if (w / 2 != 1) {
        EXPECT_LT(std::abs(heat.heat_W[c.enclosure.sphere_count() + w]), 1e-8 * largest(heat.heat_W));
      }
    Case even = small_bed(0.4);
    even.sphere_temperature_K.assign(even.sphere_temperature_K.size(), 700);
    for (auto& w : even.enclosure.walls) w.temperature_K = 700;
    even.surroundings_K = 700;
    for (const double q : source.net_heat(even.enclosure, even.state(), 0).heat_W) EXPECT_EQ(q, 0);
  }
}

TEST(HarmonicSource, SameBitsForAnyThreadsAndOnceAssembled) {
  Case c = small_bed(0.4);
  LineOptions one = lines(20), three = lines(20);
  one.threads = 1, three.threads = 3;
  HarmonicSource a(2, one), b(2, three);
  const auto first = a.net_heat(c.enclosure, c.state(), 0);
  EXPECT_EQ(first.heat_W, b.net_heat(c.enclosure, c.state(), 0).heat_W);
  EXPECT_EQ(first.heat_W, a.net_heat(c.enclosure, c.state(), 1).heat_W);
}

// Between equal plates far wider than their distance: eps .8 and .5. Planted: absorptivity of the other
// plate.
TEST(HarmonicSource, GreyCubeOfTwoEmittersIsThatOfPaths) {
  Case c;
  c.add_box({{0, 0, 0}, {1, 1, 1}}, WallRole::adiabatic, 300, 1);
  c.wall(4).role = c.wall(5).role = WallRole::isothermal;
  c.wall(5).temperature_K = 1000, c.wall(5).emissivity = 0.8;
  c.wall(4).temperature_K = 500, c.wall(4).emissivity = 0.5;
  HarmonicSource source(1, lines(100));
  const auto heat = source.net_heat(c.enclosure, c.state(), 0);
  const auto exact = c.trace(walks(200000));
  EXPECT_NEAR(heat.heat_W[4], exact.heat_W[4],
              4 * std::hypot(exact.standard_error_W[4], heat.standard_error_W[4]) + 0.002 * exact.heat_W[4]);
  EXPECT_NEAR(heat.heat_W[4], 17036,
              0.005 * 17036);  // re-emission where the light falls; two ways, see paths
}

// A black sphere in a grey cube sees its walls' temperature; a grey one in a black cube takes eps A sigma
// T^4.
TEST(HarmonicSource, GreySphereInABlackCube) {
  Case c;
  c.add_box({{0, 0, 0}, {0.004, 0.004, 0.004}}, WallRole::isothermal, 1000, 1);
  c.add_sphere({0.0018, 0.002, 0.0021}, 8e-4, 300, 0.3);
  for (const int order : {1, 3}) {
    HarmonicSource source(order, lines(300));
    const auto heat = source.net_heat(c.enclosure, c.state(), 0);
    const double exact = 0.3 * 4 * pi * 8e-4 * 8e-4 * (emissive_power(1000) - emissive_power(300));
    EXPECT_NEAR(heat.heat_W[0], exact, 4 * heat.standard_error_W[0] + 1e-3 * exact) << order;
  }
}

TEST(HarmonicSource, RefusesExcludedWalls) {
  Case c = small_bed(0.4, 2);
  c.wall(0).role = WallRole::excluded;
  HarmonicSource source(1, lines(20));
  EXPECT_THROW(source.net_heat(c.enclosure, c.state(), 0), Error);
}

/// Error of the wall heat against traced paths, %, by order, in the channel at a solid fraction of 0.43.
void expect_bias(double emissivity, const std::map<int, double>& most_percent, int directions,
                 std::int64_t count) {
  PackingRequest request;
  request.where = {{{0, 0, 0}, {0.010, 0.004, 0.050}}, {}};
  request.radius_m = equal_radii(request.where.box, 0.43, 4e-4);
  Case c;
  c.add_box(request.where.box, WallRole::adiabatic, 300, emissivity);
  for (int w : {2, 3}) c.wall(w).role = WallRole::isothermal, c.wall(w).temperature_K = 1000;
  for (const auto& centre : pack_spheres(request)) c.add_sphere(centre, 4e-4, 300, emissivity);
  const auto exact = c.trace(walks(count));
  const double noise = 100 * exact.isothermal_wall_heat_error_W / exact.isothermal_wall_heat_W;
  for (const auto& [order, most] : most_percent) {
    HarmonicSource source(order, lines(directions));
    const auto heat = source.net_heat(c.enclosure, c.state(), 0);
    const double error = 100 * (heat.isothermal_wall_heat_W / exact.isothermal_wall_heat_W - 1);
    const double lines_noise = 100 * heat.isothermal_wall_heat_error_W / exact.isothermal_wall_heat_W;
    std::printf("eps %.1f order %d: %+.2f %% +- %.2f (paths), +- %.2f (lines)\n", emissivity, order, error,
                noise, 100 * heat.isothermal_wall_heat_error_W / exact.isothermal_wall_heat_W);
    EXPECT_LT(std::abs(error), most + 3 * std::hypot(noise, lines_noise)) << order;
  }
}

// Independent computation: L = 0 +13, L = 1 +1.6, L = 2 +0.8, L = 3 +0.5 %. Planted: order 1 for 2
// exceeds 1.3.
TEST(HarmonicSource, TakesTheBiasAway) {
  expect_bias(0.4, {{1, 2.2}}, 40, 50000);
}
TEST(HarmonicSourceLong, BiasByOrder) {
  expect_bias(0.1, {{1, 2.2}, {2, 1.6}, {3, 1.2}}, 60, 1000000);
  expect_bias(0.4, {{1, 2.1}, {2, 1.3}, {3, 1.0}}, 60, 1000000);
  expect_bias(0.7, {{1, 1.6}, {2, 0.9}, {3, 0.8}}, 60, 1000000);
}

}  // namespace
}  // namespace granrad
