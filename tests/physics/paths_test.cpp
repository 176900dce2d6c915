// Requirement: traced paths conserve energy exactly, leave an isothermal bed alone, obey reciprocity, and
// give the same bits for any number of threads. Planted, seen to fail: heat given to the end only (four
// tests); emissive power of the neighbouring surface number (isothermal, reciprocity).
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "dem/base/error.h"
#include "path_cases.h"

namespace granrad {
namespace {

using namespace path_cases;

TEST(PathsPhysics, EnergySumIsExactlyZero) {
  for (double emissivity : {0.2, 0.9}) {
    auto heat = small_bed(emissivity).trace(walks(5000));
    EXPECT_EQ(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0), 0.0);
    std::sort(heat.heat_W.begin(), heat.heat_W.end());
    EXPECT_EQ(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0), 0.0) << "in any order";
    EXPECT_GT(heat.isothermal_wall_heat_W, 0);
  }
}

TEST(PathsPhysics, ConservesEnergyWithOpenWallsAndSurroundings) {
  Case c = small_bed(0.4);
  c.wall(0).role = WallRole::open;
  c.enclosure.walls.pop_back();
  const auto heat = c.trace(walks(5000));
  EXPECT_EQ(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0), 0.0);
  EXPECT_GT(heat.heat_W.back(), 0) << "the surroundings are colder than the walls";
  const double walls = std::accumulate(heat.heat_W.begin() + 125, heat.heat_W.end(), 0.0);
  EXPECT_EQ(heat.isothermal_wall_heat_W, -walls);
}

TEST(PathsPhysics, IsothermalBedGetsExactlyNothing) {
  for (double emissivity : {0.1, 0.5, 0.95, 1.0}) {
    Case c = small_bed(emissivity);
    std::fill(c.sphere_temperature_K.begin(), c.sphere_temperature_K.end(), 1000);
    for (double q : c.trace(walks(5000)).heat_W) EXPECT_EQ(q, 0);
  }
}

TEST(PathsPhysics, ReradiatingAndExcludedWallsGetNothing) {
  Case c = small_bed(0.6);
  c.wall(0).role = c.wall(1).role = WallRole::excluded;
  const auto heat = c.trace(walks(5000));
  for (int w : {0, 1, 4, 5}) EXPECT_EQ(heat.heat_W[125 + w], 0) << "wall " << w;
  EXPECT_EQ(std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0), 0.0);
}

TEST(PathsPhysics, SameBitsForAnyNumberOfThreads) {
  const Case c = small_bed(0.4);
  PathOptions o = walks(4000);
  o.threads = 1;
  const auto one = c.trace(o, 7);
  for (int threads : {2, 5}) {
    o.threads = threads;
    const auto several = c.trace(o, 7);
    EXPECT_EQ(one.heat_W, several.heat_W);
    EXPECT_EQ(one.standard_error_W, several.standard_error_W);
    EXPECT_EQ(one.rays, several.rays);
  }
  EXPECT_NE(one.heat_W, c.trace(o, 8).heat_W) << "another update draws other numbers";
}

// Walks that start on the walls and walks that start on the particles estimate the same exchange areas.
TEST(PathsPhysics, ObeysReciprocity) {
  for (double emissivity : {0.3, 0.8}) {
    Case c = small_bed(emissivity);
    c.wall(2).emissivity = 0.5 * emissivity;
    std::fill(c.sphere_temperature_K.begin(), c.sphere_temperature_K.end(), 300);
    PathOptions o = walks(150000);
    o.wall_share = 1;
    const auto from_walls = c.trace(o);
    o.wall_share = 0;
    const auto from_particles = c.trace(o);
    for (std::size_t s : {127u, 128u}) {
      const double sigma = std::hypot(from_walls.standard_error_W[s], from_particles.standard_error_W[s]);
      EXPECT_NEAR(from_walls.heat_W[s], from_particles.heat_W[s], 4 * sigma);
      EXPECT_LT(sigma, 0.02 * std::abs(from_walls.heat_W[s]));
    }
    double chi2 = 0;
    for (int i = 0; i < 125; ++i) {
      const double d = from_walls.heat_W[i] - from_particles.heat_W[i];
      const double s = std::hypot(from_walls.standard_error_W[i], from_particles.standard_error_W[i]);
      chi2 += d * d / (s * s);
    }
    EXPECT_GT(chi2 / 125, 0.75) << "expected 15/14, standard deviation 0.13";
    EXPECT_LT(chi2 / 125, 1.5);
  }
}

TEST(PathsPhysics, WeightedAndAnalogWalksAgree) {
  const Case c = small_bed(0.5);
  PathOptions o = walks(100000);
  o.weighted_below = 0;
  const auto analog = c.trace(o);
  o.weighted_below = 2;
  const auto weighted = c.trace(o, 1);
  EXPECT_NEAR(analog.isothermal_wall_heat_W, weighted.isothermal_wall_heat_W,
              4 * std::hypot(analog.isothermal_wall_heat_error_W, weighted.isothermal_wall_heat_error_W));
}

TEST(PathsPhysics, BlackEnclosureIsSolvedByOneSegmentPerWalk) {
  Case c = small_bed(1);
  for (int w : {0, 1, 4, 5}) c.wall(w).role = WallRole::open;
  EXPECT_EQ(c.trace(walks(3200)).rays, 3200);
}

TEST(PathsPhysics, RefusesTooFewWalks) {
  EXPECT_THROW(small_bed(0.5).trace(walks(10)), InputError);
}

TEST(PathsPhysics, EmptyAndColdEnclosuresAreNoProblem) {
  Case empty;
  EXPECT_EQ(empty.trace(walks(100)).heat_W, std::vector<double>{0.0});
  Case box;
  box.add_box({{0, 0, 0}, {1, 1, 1}}, WallRole::adiabatic, 300, 1);
  for (double q : box.trace(walks(100)).heat_W) EXPECT_EQ(q, 0);
  Case lone;
  lone.add_sphere({0, 0, 0}, 1, 1000, 0.5);
  const auto heat = lone.trace(walks(3200));
  EXPECT_NEAR(heat.heat_W[1] / (0.5 * 4 * pi * (emissive_power(1000) - emissive_power(300))), 1, 1e-11)
      << "every walk of a lone sphere ends outside: no noise";
}

TEST(PathsPhysics, SourceRebuildsItsTracerWhenTheBedMoves) {
  Case c = small_bed(0.4);
  PathSource source(walks(2000));
  const auto before = source.net_heat(c.enclosure, c.state(), 1);
  EXPECT_EQ(before.heat_W, c.trace(walks(2000), 1).heat_W);
  c.enclosure.centre_m[3].x += 2e-5;
  EXPECT_EQ(source.net_heat(c.enclosure, c.state(), 1).heat_W, c.trace(walks(2000), 1).heat_W);
}

}  // namespace
}  // namespace granrad
