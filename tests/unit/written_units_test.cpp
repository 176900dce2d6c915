// Requirement: results are printed in the units the scene is written in; without any, in SI.
// Planted, seen to fail: the zero of degC left out.
#include <gtest/gtest.h>

#include "coupling/results/written_units.h"

using namespace granrad;

namespace {

Case written(const std::string& text) {
  Case c;
  c.effective_text = text;
  return c;
}

}  // namespace

TEST(WrittenUnits, AreThoseOfTheScene) {
  const Case c = written(
      "[feed]\nmass_flow_kg_s = '1.59 g/s'\nvelocity_m_s = '4 cm/s'\n\n"
      "[particles]\ndiameter_m = '0.8 mm'\ntemperature_K = '27 degC'\n\n[scene]\nend_time_s = '2 min'\n");
  const auto flow = written_unit(c, "kg/s"), K = written_unit(c, "K"), speed = written_unit(c, "m/s"),
             time = written_unit(c, "s");
  EXPECT_EQ(flow.name, "g/s");
  EXPECT_NEAR(flow.of(1.59e-3), 1.59, 1e-12);
  EXPECT_EQ(K.name, "degC");
  EXPECT_NEAR(K.of(373.15), 100, 1e-9);
  EXPECT_NEAR(K.difference(2), 2, 1e-12);  // an error has no zero
  EXPECT_NEAR(speed.of(0.04), 4, 1e-12);
  EXPECT_NEAR(time.of(90), 1.5, 1e-12);
}

TEST(WrittenUnits, AreSIWhereTheSceneHasPlainNumbers) {
  const Case c = written("[feed]\nmass_flow_kg_s = 1.59e-3\n\n[particles]\ntemperature_K = 300\n");
  for (const char* unit : {"kg/s", "K", "m/s", "s", "W"}) {
    EXPECT_EQ(written_unit(c, unit).name, unit);
    EXPECT_EQ(written_unit(c, unit).of(0.7), 0.7);
  }
}

TEST(WrittenUnits, OfTheFirstWallWhereParticlesHaveNone) {
  EXPECT_EQ(
      written_unit(written("[particles]\ntemperature_K = 300\n\n[walls.y_min]\ntemperature_K = '700 degC'\n"),
                   "K")
          .name,
      "degC");
  const Case mesh =
      written("[[mesh]]\nname = 'w'\n\n    [mesh.solid.heaters]\n    temperature_K = '500 degC'\n");
  EXPECT_EQ(written_unit(mesh, "K").name, "degC");
}
