// Requirement: traced paths stay right, and their work bounded, where surfaces differ by orders of magnitude: small
// particles beside large ones, dim surfaces, intervals beyond the radiative time constant, plates of kilometres.
// Planted, seen to fail: starts raised without their density (SmallBesideLarge); area of
// a walk by its own end alone (DimSurfacesMix); what a long walk still carries thrown
// away (DimSurfacesMix: 2500 times too little); what is not kept sent out again where it arrived (SpreadsWhatItDoesNot
// Keep); a quantum of 2^-50 of all that is emitted (SmallSphereBetweenVastPlates: exactly 0).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "coupling/heat/radiosity_source.h"
#include "path_cases.h"
#include "raytrace/exact.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {
namespace {

using namespace path_cases;

RadiativeHeat traced(const Case& c, const RadiativeState& state, const PathOptions& options,
                     std::uint64_t update = 0) {
  const EmbreeTracer tracer(c.enclosure, options.threads);
  return trace_paths(c.enclosure, tracer, state, options, update);
}

double sum(const RadiativeHeat& heat) {
  return std::accumulate(heat.heat_W.begin(), heat.heat_W.end(), 0.0);
}

// A large cold sphere and two that are 1000 times smaller, between black walls at 1000 K. Two spheres exchange by a
// closed form, the rest of what the small one sees are walls.
TEST(PathExtremes, SmallBesideLarge) {
  Case c;
  c.add_box({{0, 0, 0}, {0.02, 0.02, 0.02}}, WallRole::isothermal, 1000, 1);
  const double large = 5e-3, small = 5e-6;
  c.add_sphere({0.01, 0.01, 0.01}, large, 300, 1);
  c.add_sphere({0.0045, 0.01, 0.01}, small, 600, 1);
  c.add_sphere({0.001, 0.001, 0.001}, small, 600, 1);
  RadiativeState state = c.state();
  state.relaxation.assign(c.enclosure.surface_count(), 0);
  state.relaxation[1] = state.relaxation[2] = 0.05;
  const double area = 4 * pi * small * small, F = exact_two_sphere(small, large, 0.0055);
  const double exact = area * ((1 - F) * (emissive_power(1000) - emissive_power(600)) +
                               F * (emissive_power(300) - emissive_power(600)));
  double mean = 0, squares = 0;
  constexpr int updates = 400;
  for (int update = 0; update < updates; ++update) {
    const auto heat = traced(c, state, walks(64), static_cast<std::uint64_t>(update));
    EXPECT_NEAR(sum(heat), 0, 1e-9 * heat.isothermal_wall_heat_W);
    mean += heat.heat_W[1] / updates;
    squares += heat.heat_W[1] * heat.heat_W[1] / updates;
  }
  const double sigma = std::sqrt((squares - mean * mean) / (updates - 1));
  EXPECT_NEAR(mean, exact, 4 * sigma);
  EXPECT_LT(sigma / exact, 0.03) << "5 walks of its own in each update";
  state.relaxation.clear();
  EXPECT_EQ(traced(c, state, walks(64)).heat_W[1], 0) << "by area alone it is never met";
}

// As emissivities go to 0 light mixes: walls and particles exchange eps A_w A_p / (A_w + A_p), whatever lies where.
TEST(PathExtremes, DimSurfacesMix) {
  Case c = small_bed(1e-6);
  for (int w : {0, 1, 4, 5}) c.wall(w).role = WallRole::adiabatic;
  std::fill(c.sphere_temperature_K.begin(), c.sphere_temperature_K.end(), 300);
  const auto area = surface_areas(c.enclosure);
  const double particles = std::accumulate(area.begin(), area.begin() + 125, 0.0),
               walls = area[127] + area[128];
  const double exact =
      1e-6 * particles * walls / (particles + walls) * (emissive_power(1000) - emissive_power(300));
  const auto heat = c.trace(walks(3200));
  EXPECT_NEAR(heat.isothermal_wall_heat_W, exact, 4 * heat.isothermal_wall_heat_error_W);
  EXPECT_LT(heat.isothermal_wall_heat_error_W, 0.02 * exact);
  EXPECT_LT(heat.rays, 3200 * 1200) << "absorbed by few, met by all: re-radiating walls are met on the way";
  EXPECT_NEAR(sum(heat), 0, 1e-12 * exact);
}

TEST(PathExtremes, ReflectingParticlesGetNothing) {
  Case c = small_bed(0);
  for (int w : {2, 3}) c.wall(w).emissivity = 0.8;
  c.wall(3).temperature_K = 500;
  const auto heat = c.trace(walks(3200));
  for (int i = 0; i < 125; ++i) EXPECT_EQ(heat.heat_W[i], 0);
  EXPECT_GT(heat.heat_W[128], 0) << "the colder wall is heated through the bed";
  EXPECT_EQ(heat.heat_W[127], -heat.heat_W[128]);
}

// A black sphere that keeps little of what it gets, between black walls one of which is hot: it shines on all walls
// alike, which view factors with one radiosity a surface describe exactly.
TEST(PathExtremes, SpreadsWhatItDoesNotKeep) {
  Case c;
  c.add_box({{0, 0, 0}, {1, 1, 1}}, WallRole::isothermal, 300, 1);
  c.wall(2).temperature_K = 1000;
  c.add_sphere({0.5, 0.5, 0.5}, 0.45, 400, 1);
  RadiativeState state = c.state();
  state.relaxation.assign(c.enclosure.surface_count(), 0);
  state.relaxation[0] = 50;
  state.implicit = true;
  TraceOptions rays;
  rays.rays_per_particle = 2e5;
  rays.threads = 1;
  RadiositySource source(
      [&](const Enclosure& e, std::uint64_t) { return one_way_estimate(trace_view_factors(e, rays)); },
      Closure::reciprocal);
  const auto exact = source.net_heat(c.enclosure, state, 0);
  const auto heat = traced(c, state, walks(300000));
  for (std::size_t s = 0; s < 7; ++s)
    EXPECT_NEAR(heat.heat_W[s], exact.heat_W[s],
                4 * std::hypot(heat.standard_error_W[s], exact.standard_error_W[s]))
        << s;
  EXPECT_LT(heat.standard_error_W[4], 0.01 * heat.heat_W[4])
      << "the wall opposite: little but what the sphere sends";
  EXPECT_NEAR(
      heat.heat_W[0] * 51,
      4 * pi * 0.45 * 0.45 * ((emissive_power(1000) + 5 * emissive_power(300)) / 6 - emissive_power(400)),
      51 * 4 * heat.standard_error_W[0]);
}

// Walks chosen for an error: it is reached in the mean over updates; a first look may be enough.
TEST(PathExtremes, WalksAreChosenForTheErrorWanted) {
  const Case c = small_bed(0.4);
  PathOptions options = walks(0);
  options.threads = 1;
  PathSource source(options);
  RadiativeState state = c.state();
  const auto look = source.net_heat(c.enclosure, state, 0);
  for (const double relative : {0.04, 0.002}) {  // the first look knows it to 0.3 %
    state.wanted_error_W = relative * look.isothermal_wall_heat_W;
    double squares = 0;
    constexpr int updates = 10;
    for (std::uint64_t update = 1; update <= updates; ++update)
      squares +=
          std::pow(source.net_heat(c.enclosure, state, update).isothermal_wall_heat_error_W, 2) / updates;
    const double ratio = std::sqrt(squares) / state.wanted_error_W;
    if (relative < 0.02) {
      EXPECT_GT(ratio, 0.5) << "not by four times the work: even starts gain more than walks alone";
    }
    EXPECT_LT(ratio, 1.1) << relative;
  }
}

// A millimetre's sphere between plates of a kilometre, 1 cm apart: half of what it sees is hot.
TEST(PathExtremes, SmallSphereBetweenVastPlates) {
  Case c;
  c.add_box({{-500, -500, 0}, {500, 500, 0.01}}, WallRole::isothermal, 300, 1);
  c.wall(4).temperature_K = 1000;
  c.add_sphere({0, 0, 0.005}, 1e-3, 300, 1);
  const double exact = 2 * pi * 1e-6 * (emissive_power(1000) - emissive_power(300));
  const auto heat = c.trace(walks(100000));
  EXPECT_NEAR(heat.heat_W[0], exact, 4 * heat.standard_error_W[0] + 1e-6 * exact);
  EXPECT_LT(heat.standard_error_W[0], 0.01 * exact);
}

}  // namespace
}  // namespace granrad
