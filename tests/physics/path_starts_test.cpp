// Requirement: walks start where heats are decided, whatever the temperatures are, and the heats stay right and their
// stated errors true. Planted, seen to fail: the surroundings forgotten where the room is open (FindTheSurroundings: the
// sphere loses nothing to them); starts by area alone (AreSpentWhereTheyTell); clear flights whose expectation is not taken
// off, that end at the first sphere, or meet spheres that a wall cuts (TakeNoiseOutAndNothingElse).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "path_cases.h"
#include "raytrace/exact.h"

namespace granrad {
namespace {

using namespace path_cases;

/// Two hot walls and particles of one temperature, but for `off_K` of every seventh.
Case bed_of_one_temperature(double emissivity, double off_K = 0) {
  Case c = small_bed(emissivity);
  for (std::size_t i = 0; i < c.sphere_temperature_K.size(); ++i)
    c.sphere_temperature_K[i] = i % 7 == 3 ? 300 + off_K : 300;
  return c;
}

PathOptions with_share(std::int64_t count, double share) {
  PathOptions options = walks(count);
  options.wall_share = share;
  return options;
}

struct Found {
  double mean_W = 0, spread_W = 0, stated_W = 0;  ///< of the wall heat of one update
  double error_W = 0;                             ///< of the mean
  std::vector<double> heat_W, heat_error2_W2;     ///< of each surface: mean, variance of it
};

Found over_updates(const Case& c, const PathOptions& options, int updates) {
  const EmbreeTracer tracer(c.enclosure, 1);
  double sum = 0, squares = 0, stated2 = 0;
  const std::size_t surfaces = c.enclosure.surface_count();
  std::vector<double> heat(surfaces, 0), heat2(surfaces, 0);
  for (int u = 0; u < updates; ++u) {
    const auto found = trace_paths(c.enclosure, tracer, c.state(), options, static_cast<std::uint64_t>(u));
    sum += found.isothermal_wall_heat_W;
    squares += std::pow(found.isothermal_wall_heat_W, 2);
    stated2 += std::pow(found.isothermal_wall_heat_error_W, 2) / updates;
    for (std::size_t s = 0; s < surfaces; ++s)
      heat[s] += found.heat_W[s] / updates, heat2[s] += std::pow(found.standard_error_W[s] / updates, 2);
  }
  const double mean = sum / updates, variance = (squares - sum * mean) / (updates - 1);
  return {mean, std::sqrt(variance), std::sqrt(stated2), std::sqrt(variance / updates), heat, heat2};
}

// 100 updates: spreads are known to 7 %, stated errors (16 batches each) to 1.8 %; 4 sigma.
TEST(PathStartsPhysics, AreSpentWhereTheyTell) {
  for (const double emissivity : {1.0, 0.4}) {
    const Case c = bed_of_one_temperature(emissivity);
    PathOptions options = walks(3200);
    const Found free = over_updates(c, options, 100), even = over_updates(c, with_share(3200, 0.75), 100);
    EXPECT_NEAR(free.mean_W, even.mean_W, 4 * std::hypot(free.error_W, even.error_W));
    EXPECT_NEAR(free.spread_W / free.stated_W, 1, 0.29) << "emissivity " << emissivity;
    EXPECT_LT(free.stated_W, (emissivity == 1 ? 0.8 : 0.95) * even.stated_W) << "emissivity " << emissivity;
  }
}

// Few walks start on particles that differ by little: each counts for more, and the exchange among them is not lost.
TEST(PathStartsPhysics, KeepSmallDifferencesAmongParticles) {
  Case c = bed_of_one_temperature(0.7, 5);
  for (auto& wall : c.enclosure.walls) wall.role = WallRole::adiabatic;
  c.wall(2).role = WallRole::isothermal;
  c.wall(2).temperature_K = 310, c.wall(2).emissivity = 0.02;
  const auto few = c.trace(walks(400000)), half = c.trace(with_share(400000, 0.5), 1);
  double sum_few = 0, sum_half = 0, error2 = 0;
  for (std::size_t i = 3; i < 125; i += 7) {
    sum_few += few.heat_W[i], sum_half += half.heat_W[i];
    error2 += std::pow(few.standard_error_W[i], 2) + std::pow(half.standard_error_W[i], 2);
  }
  EXPECT_NEAR(sum_few, sum_half, 4 * std::sqrt(error2));
  EXPECT_LT(std::sqrt(error2), 0.03 * std::abs(sum_half));
}

// A sphere over a small hot plate in the open: what it gives to the cold surroundings no walk from the plate finds.
TEST(PathStartsPhysics, FindTheSurroundings) {
  Case c;
  c.surroundings_K = 200;
  c.add_wall(plate(0, true), WallRole::isothermal, 500, 1);
  c.add_sphere({0.5, 0.5, 0.8}, 0.3, 400, 1);
  const double F = exact_sphere_wall(c.enclosure.centre_m[0], c.wall(0)), area = 4 * pi * 0.3 * 0.3;
  const double exact = area * (F * emissive_power(500) + (1 - F) * emissive_power(200) - emissive_power(400));
  const auto heat = c.trace(walks(100000));
  EXPECT_NEAR(heat.heat_W[0], exact, 4 * heat.standard_error_W[0]);
  EXPECT_LT(heat.standard_error_W[0], 0.01 * std::abs(exact));
}

constexpr std::size_t cut = 7;

/// Three fifths of the size, so that lines cross a sphere or none; one sphere is cut by a hot wall, two overlap.
Case thin_bed(double emissivity) {
  Case c = bed_of_one_temperature(emissivity);
  for (double& r : c.enclosure.radius_m) r *= 0.6;
  c.enclosure.centre_m[cut].y = 0.5 * c.enclosure.radius_m[cut];
  c.enclosure.centre_m[60] = c.enclosure.centre_m[61] + Vec3{1.5 * c.enclosure.radius_m[61], 0, 0};
  return c;
}

// 960 walks are too few for the 250 pairs: those updates know nothing of clear flights. chi^2 of 127 surfaces: 12.5 %.
TEST(ClearFlightsPhysics, TakeNoiseOutAndNothingElse) {
  for (const double emissivity : {1.0, 0.4}) {
    const Case c = thin_bed(emissivity);
    const Found with = over_updates(c, walks(3200), 125), without = over_updates(c, walks(960), 400);
    EXPECT_NEAR(with.mean_W, without.mean_W, 4 * std::hypot(with.error_W, without.error_W));
    EXPECT_NEAR(with.spread_W / with.stated_W, 1, 0.26);
    EXPECT_LT(with.stated_W * std::sqrt(3200),
              (emissivity == 1 ? 0.92 : 0.95) * without.stated_W * std::sqrt(960));
    double chi2 = 0;
    for (std::size_t s = 0; s < 125; ++s)
      chi2 += std::pow(with.heat_W[s] - without.heat_W[s], 2) /
              (with.heat_error2_W2[s] + without.heat_error2_W2[s]);
    EXPECT_NEAR(chi2 / 125, 1, 0.5);
    EXPECT_NEAR(with.heat_W[cut], without.heat_W[cut],
                4 * std::sqrt(with.heat_error2_W2[cut] + without.heat_error2_W2[cut]));
  }
}

// What a sphere between a hot and a cold wall gets comes from the one and is kept from the other: there, clear flights tell
// nothing of the wall heat, and are not taken out.
TEST(ClearFlightsPhysics, AreLeftWhereTheyTellNothing) {
  Case c = thin_bed(1);
  c.wall(3).temperature_K = 300;
  for (double& T : c.sphere_temperature_K) T = 300;
  c.wall(2).temperature_K = 1000;
  Case level = c;
  const double middle = std::pow((emissive_power(1000) + emissive_power(300)) / 2 / stefan_boltzmann, 0.25);
  for (double& T : level.sphere_temperature_K) T = middle;
  for (const Case& each : {c, level}) {
    const Found with = over_updates(each, walks(3200), 100), without = over_updates(each, walks(960), 200);
    EXPECT_NEAR(with.mean_W, without.mean_W, 4 * std::hypot(with.error_W, without.error_W));
    EXPECT_LT(with.stated_W * std::sqrt(3200), 1.1 * without.stated_W * std::sqrt(960));
  }
}

}  // namespace
}  // namespace granrad
