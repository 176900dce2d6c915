// Requirement: heat in a periodic box does not care in which period a particle is: a bed that drifts through ten
// periods warms like the same bed at rest, by contacts, gas and radiation; so does a bed whose particles start in other
// periods; profiles and solid fraction too.
//
// Planted, seen: the region asked for positions as they are, not as they lie in the box: nothing conducts once a particle has
// crossed (the temperatures stay apart by 2 K). Fails here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupling/simulation/simulation.h"
#include "dem/bed/near_pairs.h"
#include "dem/bed/solid_fraction.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

constexpr double period = 0.02;

struct Start {
  double drift_m_s = 0;
  int periods = 0;  ///< by which every second particle is moved
  std::string radiation{};
};

/// Two touching pairs, one across the border, after 0.4 s.
Bed warmed(const Start& start) {
  const TemporaryFolder folder;
  const double x[] = {0.0095, 0.01149, 0.019, 0.02099}, t[] = {400, 300, 500, 350};
  std::string bed = "x,y,z,radius,temperature,vx,vy,vz\n";
  for (int k = 0; k < 4; ++k)
    bed += fmt::format("{},0.005,0.005,0.001,{},{},0,0\n", x[k] + (k % 2) * start.periods * period, t[k],
                       start.drift_m_s);
  folder.write("bed.csv", bed);
  std::string text =
      "[scene]\nname = \"p\"\nend_time_s = 0.4\n[material]\ndensity_kg_m3 = 2500\nspecific_heat_J_kgK = 800\n"
      "conductivity_W_mK = 1\nyoungs_modulus_Pa = 5e6\nreal_youngs_modulus_Pa = 5e6\npoisson_ratio = 0.3\n"
      "restitution = 0.5\nfriction = 0\nemissivity = 1\n[gas]\nconductivity_W_mK = 0.05\nlens_radius_ratio = 1.4\n"
      "[particles]\nfile = \"bed.csv\"\n[box]\nsize_m = [0.02, 0.01, 0.01]\nperiodic = [\"x\"]\n";
  if (!start.radiation.empty()) {
    text += "[radiation]\nevery_s = 0.05\n" + start.radiation;
    for (const char* wall : {"y_min", "y_max", "z_min", "z_max"})
      text += fmt::format("[walls.{}]\nrole = \"isothermal\"\ntemperature_K = 1500\nemissivity = 1\n", wall);
  }
  const Case c = read_case(folder.write("scene.toml", text), {});
  Simulation simulation(c, 1);
  simulation.start();
  while (!simulation.finished()) simulation.advance();
  EXPECT_NEAR(solid_fraction(simulation.bed(), c.flow.region), 4 * 4.0 / 3 * 3.141592653589793 * 1e-9 / 2e-6,
              1e-12);
  return simulation.bed();
}

TEST(PeriodicHeat, ABedThatDriftsThroughPeriodsConductsLikeOneAtRest) {
  const Bed still = warmed({}), drifting = warmed({.drift_m_s = 0.5});
  ASSERT_GT(drifting.position_m[0].x, 9 * period);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(drifting.temperature_K[i], still.temperature_K[i], 1e-6);
  EXPECT_GT(still.temperature_K[1], 300.1) << "something is conducted";
  EXPECT_GT(still.temperature_K[3], 350.03) << "across the border too";
}

TEST(PeriodicHeat, ItDoesNotMatterInWhichPeriodAParticleStarts) {
  const Bed still = warmed({}), elsewhere = warmed({.periods = 3});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(elsewhere.temperature_K[i], still.temperature_K[i], 1e-6);
}

TEST(PeriodicHeat, RadiationGoesOnAcrossTheBorder) {
  for (const std::string radiation :
       {"source = \"paths\"\nrays = 2000\n", "source = \"embree\"\nrays = 100\n"}) {
    const Bed still = warmed({.radiation = radiation}),
              drifting = warmed({.drift_m_s = 0.5, .radiation = radiation});
    double gained = 0, other = 0;
    for (std::size_t i = 0; i < 4; ++i)
      gained += still.temperature_K[i] / 4, other += drifting.temperature_K[i] / 4;
    EXPECT_GT(gained, 420);
    EXPECT_NEAR(other, gained, 0.05 * (gained - 387.5));
  }
}

}  // namespace
}  // namespace granrad
