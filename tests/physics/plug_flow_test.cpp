// Requirement: with the native engine the plug keeps solid fraction and mass flow within 1 % of what was
// asked, over the residence times run here, in spite of collisions and wall friction; and a flow saved with
// its feed goes on bit for bit. Short: a channel of 10 mm. Long: the whole channel, two residence times.
// Planted error seen to fail here: newcomers a tenth too slow. The friction loss itself needs the long test.
#include <gtest/gtest.h>

#include "dem/engine_native.h"
#include "dem/feed/feed.h"
#include "tests/feed_scenes.h"

namespace granrad {
namespace {

using namespace testing_scenes;

constexpr double step_s = 1e-5;
constexpr std::int64_t steps_per_update = 100;

void advance(Feed& feed, Engine& engine, Bed& bed) {
  feed.update(bed);
  engine.advance(bed, (static_cast<double>(bed.step + steps_per_update) - 0.5) * step_s);
}

/// Runs for `residences` times height / speed; the last one is measured.
void expect_plug(double phi, double height_m, double residences) {
  SCOPED_TRACE(phi);
  const Scene scene = plug_scene(phi, height_m);
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  const auto engine = make_native_engine(bed, {}, step_s);
  const double residence_s = height_m * 3984 * phi * 4e-5 / 1.59e-3;
  double sum = 0, start_s = 0;
  int samples = 0;
  FeedTotals before;
  while (bed.time_s < residences * residence_s) {
    advance(feed, *engine, bed);
    if (bed.time_s < (residences - 1) * residence_s) {
      before = feed.totals(), start_s = bed.time_s;
      continue;
    }
    sum += solid_fraction(bed, scene.box), ++samples;
  }
  EXPECT_NEAR(sum / samples, phi, 0.01 * phi);
  const double flow = 1.59e-3 * (bed.time_s - start_s);
  EXPECT_NEAR(feed.totals().mass_in_kg - before.mass_in_kg, flow, 0.01 * flow);
  EXPECT_NEAR(feed.totals().mass_out_kg - before.mass_out_kg, flow, 0.02 * flow);  // shorter than its noise
  EXPECT_EQ(feed.totals().waiting, 0);
  std::printf("phi %.2f: mean %.4f, in %.4f g/s, out %.4f g/s, nudged %ld of %ld\n", phi, sum / samples,
              1e3 * (feed.totals().mass_in_kg - before.mass_in_kg) / (bed.time_s - start_s),
              1e3 * (feed.totals().mass_out_kg - before.mass_out_kg) / (bed.time_s - start_s),
              static_cast<long>(feed.totals().nudged), static_cast<long>(feed.totals().inserted));
}

TEST(PlugFlow, HoldsSolidFractionAndMassFlow) {
  expect_plug(0.07, 0.050, 1);
  expect_plug(0.43, 0.010, 1);
  expect_plug(0.48, 0.010, 1);
}

TEST(PlugFlow, LongWholeChannelHoldsSolidFractionAndMassFlow) {
  for (const double phi : {0.02, 0.07, 0.25, 0.43, 0.48}) expect_plug(phi, 0.050, 2);
}

TEST(PlugFlow, GoesOnBitForBitFromTheSavedState) {
  const Scene scene = plug_scene(0.43, 0.005);
  Feed straight(scene);
  Bed bed = empty_bed(scene);
  straight.start(bed);
  const auto engine = make_native_engine(bed, {}, step_s);
  for (int k = 0; k < 120; ++k) advance(straight, *engine, bed);

  Feed first(scene);
  Bed other = empty_bed(scene);
  first.start(other);
  const auto first_engine = make_native_engine(other, {}, step_s);
  for (int k = 0; k < 61; ++k) advance(first, *first_engine, other);
  Feed second(scene);
  second.load(first.save());
  const auto second_engine = make_native_engine(other, {}, step_s);
  for (int k = 61; k < 120; ++k) advance(second, *second_engine, other);
  EXPECT_EQ(bed.id, other.id);
  EXPECT_EQ(bed.position_m, other.position_m);
  EXPECT_EQ(bed.velocity_m_s, other.velocity_m_s);
}

}  // namespace
}  // namespace granrad
