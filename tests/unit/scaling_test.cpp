// Requirement: the forecast for ranks shares what ranks share and repeats what they repeat, finds where more of them stop
// helping, and the job for Slurm asks for the time and memory of the forecast and goes on where they were too short.
#include "coupling/forecast/scaling.h"

#include <gtest/gtest.h>

using namespace granrad;

namespace {

Forecast usual() {
  Forecast one;
  one.flow_s = 100, one.conduction_s = 10, one.radiation_s = 1000, one.radiation_repeated_s = 20,
  one.output_s = 1;
  one.heat_steps = 1e4, one.radiation_updates = 1000, one.mean_count = 1e4;
  one.threads = 2, one.memory_bytes = 1e9;
  return one;
}

Case plug() {
  Case c;
  c.flow.name = "a plug";
  c.heat.radiation.kind = RadiationKind::paths;
  return c;
}

TEST(Scaling, RanksShareRaysAndRepeatTheNativeFlow) {
  const auto f = forecast_on_ranks(plug(), usual(), EngineKind::native, 4);
  EXPECT_EQ(f.flow_s, 100);
  EXPECT_EQ(f.gather_s, 0);
  EXPECT_EQ(f.conduction_s, 10);
  // 980 s in four parts, 20 s on each; 1000 exchanges of 1e4 surfaces, 96 bytes each at 1 GB/s, and 4 x 50 us.
  EXPECT_NEAR(f.radiation_s, 20 + 980.0 / 4 + 1000 * (1e4 * 96 / 1e9 + 2e-4), 1e-9);
  EXPECT_EQ(f.memory_bytes, 1e9);
}

TEST(Scaling, LiggghtsSharesTheFlowAndHandsItOver) {
  const auto f = forecast_on_ranks(plug(), usual(), EngineKind::liggghts, 7);
  EXPECT_NEAR(f.flow_s, 100 * 2, 1e-9);  // 7 times as dear a core, two cores of the native engine, 7 ranks
  EXPECT_NEAR(f.gather_s, 1e4 * 1e4 * (4.5e-7 / 7 + 1.5e-7), 1e-9);
  EXPECT_NEAR(f.conduction_s, 3.5 + 6.5 / 7, 1e-9);
  EXPECT_NEAR(f.memory_bytes, 1e9 + 700 * 1e4 / 7, 1e-3);
}

// By Amdahl's law with 131 s repeated and 980 s shared, and 2 s of exchange at most: 8 -> 16 ranks saves 61 of 254 s
// (a quarter), 16 -> 32 saves 31 of 192 s (a sixth).
TEST(Scaling, StopsWhereTwiceAsManySaveLessThanAFifth) {
  EXPECT_EQ(where_it_stops_scaling(plug(), usual(), EngineKind::native, 1024), 16);
  EXPECT_EQ(where_it_stops_scaling(plug(), usual(), EngineKind::native, 8), 8);
}

TEST(Scaling, TheJobAsksForTheForecastAndGoesOn) {
  const auto job = slurm_script(plug(), usual(), 1, 2, "granrun run plug.toml -o plug");
  EXPECT_NE(job.find("--job-name=a_plug\n"), std::string::npos) << job;
  EXPECT_NE(job.find("--mem=1500M\n"), std::string::npos) << job;
  EXPECT_NE(job.find("--time=00:27:47\n"), std::string::npos) << job;  // 1.5 x 1111 s
  EXPECT_NE(job.find("\ngranrun run plug.toml -o plug --threads 2 --resume --walltime 00:22:47\n"),
            std::string::npos)
      << job;
  EXPECT_NE(slurm_script(plug(), usual(), 4, 2, "granrun").find("mpirun --map-by ppr:1:node"),
            std::string::npos);
}

}  // namespace
