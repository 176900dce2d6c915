// Requirement: what a scene does not need costs nothing, counted in updates, rays and iterations: radiation off, all that
// radiates equally warm, black surfaces.
// Planted: isothermal scenes traced all the same (10 000 walks an update).
#include <gtest/gtest.h>

#include "coupling/heat/radiosity_source.h"
#include "coupling/simulation/radiation_source.h"
#include "coupling/simulation/simulation.h"
#include "raytrace/rays/view_factors.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

Case frozen_bed(std::vector<std::string> set, const std::vector<std::string>& removed = {}) {
  set.insert(set.end(), {"scene.end_time_s=0.05", "output.every_s=0.05", "output.frames_every_s=0.05"});
  return read_case(source_dir() + "/data/scenes/static_phi007.toml", set, removed);
}

RadiationTotals ran(const Case& c, double& absolute_heat_W) {
  Simulation simulation(c, 1);
  simulation.start();
  absolute_heat_W = 0;
  while (!simulation.finished()) {
    simulation.advance();
    for (const double q : simulation.bed().radiative_heat_W) absolute_heat_W += std::abs(q);
  }
  return simulation.heat().radiation();
}

TEST(OnlyWhatIsNeeded, NoRadiationNoUpdates) {
  double heat_W = 0;
  const auto none = ran(frozen_bed({"conduction.solid=true"}, {"radiation"}), heat_W);
  EXPECT_EQ(none.updates, 0);
  EXPECT_EQ(none.rays, 0);
}

TEST(OnlyWhatIsNeeded, WhatIsEquallyWarmSendsNoRays) {
  const std::vector<std::string> walks = {"radiation.source=paths", "radiation.rays=10000"};
  auto set = walks;
  set.insert(set.end(), {"walls.y_min.temperature_K=300", "walls.y_max.temperature_K=300"});
  double heat_W = 1;
  const auto cold = ran(frozen_bed(set), heat_W);
  EXPECT_EQ(cold.updates, 5);
  EXPECT_EQ(cold.rays, 0);
  EXPECT_EQ(heat_W, 0);
  set[3] = "walls.y_max.temperature_K=301";
  const auto warm = ran(frozen_bed(set), heat_W);
  EXPECT_GE(warm.rays, 5 * 10000);
  EXPECT_GT(heat_W, 0);
}

TEST(OnlyWhatIsNeeded, BlackSurfacesNeedNoSolve) {
  for (const double emissivity : {1.0, 0.9}) {
    std::vector<std::string> set = {"material.emissivity=" + std::to_string(emissivity)};
    for (const char* wall : {"x_min", "x_max", "z_min", "z_max"}) {
      set.push_back(std::string("walls.") + wall + ".role=isothermal");
      set.push_back(std::string("walls.") + wall + ".temperature_K=300");
    }
    const Case c = frozen_bed(set);
    const Bed bed = Flow(c.flow).first_bed();
    const Enclosure enclosure = make_enclosure(bed, c.flow.region);
    RadiositySource source(
        [](const Enclosure& e, std::uint64_t) {
          TraceOptions options;
          options.rays_per_particle = 50;
          options.threads = 1;
          return one_way_estimate(trace_view_factors(e, options));
        },
        Closure::reciprocal);
    source.net_heat(enclosure, radiative_state(bed, bed.temperature_K, enclosure, 300), 0);
    if (emissivity == 1)
      EXPECT_EQ(source.iterations(), 0);
    else
      EXPECT_GT(source.iterations(), 0);
  }
}

}  // namespace
}  // namespace granrad
