// Requirement: the plug feed brings the asked solid fraction and mass flow from phi 0.02 to 0.48, filled or
// empty at the start, never inserts an overlap, carries what found no room, and continues bit for bit from
// its state. Particles fly straight here (no engine), with transverse velocities off where their drift would
// matter. Planted errors seen to fail here: a piece of tape lost at each update, newcomers not pushed clear,
// part of the tape not in the saved state. Blind to: the tape shaken up to its used end (too rare a touch).
#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "dem/feed/feed.h"
#include "tests/feed_scenes.h"

namespace granrad {
namespace {

using namespace testing_scenes;

constexpr double update_s = 2e-3;

TEST(PlugFeed, SolidFractionAndMassFlowOfAStraightPlug) {
  for (const double phi : {0.02, 0.07, 0.25, 0.43, 0.48}) {
    SCOPED_TRACE(phi);
    Scene scene = plug_scene(phi);
    scene.feed.transverse_velocity_std_m_s = 0;
    Feed feed(scene);
    Bed bed = empty_bed(scene);
    feed.start(bed);
    EXPECT_NEAR(solid_fraction(bed, scene.box), phi, 0.01 * phi);
    const double speed = 1.59e-3 / (3984 * phi * 4e-5), end = 2 * 0.050 / speed;
    double sum = 0, worst = 0;
    int samples = 0;
    while (bed.time_s < end) {
      fly(bed, update_s);
      feed.update(bed);
      const double now = solid_fraction(bed, scene.box);
      sum += now, ++samples;
      worst = std::max(worst, std::abs(now - phi));
    }
    EXPECT_NEAR(sum / samples, phi, 0.003 * phi);
    EXPECT_LT(worst, 0.02 * phi);
    EXPECT_NEAR(feed.totals().mass_in_kg, 1.59e-3 * bed.time_s, 0.006 * 1.59e-3 * bed.time_s);
    EXPECT_NEAR(feed.totals().mass_out_kg, 1.59e-3 * bed.time_s, 0.01 * 1.59e-3 * bed.time_s);
    EXPECT_EQ(feed.totals().waiting, 0);
  }
}

TEST(PlugFeed, DenseInletWithTransverseVelocitiesNeverOverlaps) {
  // Straight flight through each other makes old spheres overlap; those that come must still be clear, and
  // the count exact: a newcomer either enters or waits.
  for (const double phi : {0.25, 0.43, 0.48}) {
    SCOPED_TRACE(phi);
    const Scene scene = plug_scene(phi, 0.010);
    Feed feed(scene);
    Bed bed = empty_bed(scene);
    feed.start(bed);
    EXPECT_GE(closest_pair(bed), 1 - 1e-12);
    const double per_second = 1.59e-3 / (3984 * sphere_volume(0.4e-3));
    for (int k = 0; k < 400; ++k) {
      fly(bed, update_s);
      const auto first_new = bed.next_id;
      feed.update(bed);
      for (std::size_t i = 0; i < bed.size(); ++i) {
        if (bed.id[i] < first_new) continue;
        for (std::size_t j = 0; j < i; ++j)
          ASSERT_GE(norm(bed.position_m[i] - bed.position_m[j]), 0.8e-3 * (1 - 1e-12));
        EXPECT_GE(bed.position_m[i].x, 0.4e-3);
        EXPECT_LE(bed.position_m[i].y, 3.6e-3);
      }
    }
    const FeedTotals& t = feed.totals();
    EXPECT_NEAR(t.inserted + t.waiting, per_second * bed.time_s, 0.01 * per_second * bed.time_s);
    std::printf("phi %.2f: inserted %ld, nudged %ld, waiting %ld\n", phi, static_cast<long>(t.inserted),
                static_cast<long>(t.nudged), static_cast<long>(t.waiting));
  }
}

TEST(PlugFeed, TapeStaysFreeOfOverlapAndChanges) {
  Scene scene = plug_scene(0.48, 0.010);
  scene.feed.transverse_velocity_std_m_s = 0;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  std::vector<Vec3> before = bed.position_m;
  const double speed = 1.59e-3 / (3984 * 0.48 * 4e-5);
  int updates = 0;
  while (bed.time_s * speed < 0.05) {
    fly(bed, update_s);
    feed.update(bed);
    if (++updates % 8 == 0) {
      ASSERT_GE(closest_pair(bed), 1 - 1e-9);
    }
  }
  EXPECT_EQ(feed.totals().nudged, 0);
  const double count = feed.totals().inserted,
               wanted = 0.48 * 4e-5 * speed * bed.time_s / sphere_volume(0.4e-3);
  EXPECT_NEAR(count, wanted, 0.005 * wanted);
  // A sphere of the later filling stands where none stood at the start, up to the tape's shift.
  int at_old_place = 0;
  for (const Vec3& p : bed.position_m)
    for (const Vec3& q : before)
      if (std::abs(p.x - q.x) + std::abs(p.y - q.y) < 1e-9) ++at_old_place;
  EXPECT_LT(at_old_place, static_cast<int>(bed.size()) / 10);
}

TEST(PlugFeed, EmptyStartFillsInOneResidenceTime) {
  Scene scene = plug_scene(0.25, 0.010);
  scene.feed.transverse_velocity_std_m_s = 0;
  scene.feed.start_filled = false;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  EXPECT_EQ(bed.size(), 0u);
  const double speed = 1.59e-3 / (3984 * 0.25 * 4e-5);
  while (bed.time_s < 0.0122 / speed) {
    fly(bed, update_s);
    feed.update(bed);
  }
  EXPECT_NEAR(solid_fraction(bed, scene.box), 0.25, 0.01);
  EXPECT_EQ(feed.totals().removed, 0);
}

TEST(PlugFeed, VelocitiesOfNewcomersAreThoseAsked) {
  Scene scene = plug_scene(0.43);
  scene.materials[0].friction = 0;
  scene.feed.start_filled = false;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  double mean = 0, square = 0;
  while (bed.time_s < 1) {
    fly(bed, update_s);
    const auto first_new = bed.size();
    feed.update(bed);
    for (std::size_t i = first_new; i < bed.size(); ++i) {
      const Vec3& v = bed.velocity_m_s[i];
      EXPECT_DOUBLE_EQ(v.z, -1.59e-3 / (3984 * 0.43 * 4e-5));
      mean += v.x + v.y, square += v.x * v.x + v.y * v.y;
    }
  }
  const double n = 2.0 * bed.size();
  ASSERT_GT(n, 2000);
  // Four standard errors of mean and variance of n normal deviates.
  EXPECT_NEAR(mean / n, 0, 4 * 1e-3 / std::sqrt(n));
  EXPECT_NEAR(square / n, 1e-6, 4 * 1e-6 * std::sqrt(2 / n));
}

TEST(PlugFeed, ContinuesFromItsStateBitForBit) {
  const Scene scene = plug_scene(0.43, 0.010);
  Feed straight(scene);
  Bed bed = empty_bed(scene);
  straight.start(bed);
  for (int k = 0; k < 300; ++k) fly(bed, update_s), straight.update(bed);

  Feed first(scene);
  Bed other = empty_bed(scene);
  first.start(other);
  for (int k = 0; k < 170; ++k) fly(other, update_s), first.update(other);
  const StateBlock saved = first.save();
  Feed second(scene);
  second.load(saved);
  for (int k = 170; k < 300; ++k) fly(other, update_s), second.update(other);

  EXPECT_EQ(bed.id, other.id);
  EXPECT_EQ(bed.position_m, other.position_m);
  EXPECT_EQ(bed.velocity_m_s, other.velocity_m_s);
  EXPECT_EQ(straight.save().reals, second.save().reals);
  EXPECT_EQ(straight.save().integers, second.save().integers);
}

TEST(PlugFeed, FrozenScenesGetAPackingInsideTheBox) {
  Scene scene = plug_scene(0.43);
  scene.engine = EngineKind::none;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  EXPECT_NEAR(solid_fraction(bed, scene.box), 0.43, 2e-4);
  EXPECT_GE(closest_pair(bed), 1 - 1e-12);
  for (const Vec3& p : bed.position_m) {
    EXPECT_GE(p.z, 0.4e-3);
    EXPECT_LE(p.z, 0.0496);
  }
  const auto before = bed.size();
  bed.time_s = 1;
  feed.update(bed);
  EXPECT_EQ(bed.size(), before);
}

TEST(PlugFeed, RefusesWhatCannotFlow) {
  EXPECT_THROW(Feed(plug_scene(0.62)), InputError);
  EXPECT_THROW(Feed(plug_scene(1e-5)), InputError);
  Scene still = plug_scene(0.3);
  still.feed.mass_flow_kg_s = 0;
  EXPECT_THROW(Feed{still}, InputError);
}

}  // namespace
}  // namespace granrad
