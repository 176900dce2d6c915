// Requirement: the hopper feed starts with the asked number of spheres, replaces those that leave by cold
// ones that never overlap, carries the rest when there is no room, and continues bit for bit from its state.
// Planted errors seen to fail here: newcomers blind to each other, a batch refilled,
// counter not restored.
#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "dem/feed/feed.h"
#include "tests/feed_scenes.h"

namespace granrad {
namespace {

using namespace testing_scenes;

/// Chute of 12 x 12 mm; spheres fall straight and leave at z = -20 mm.
Scene hopper_scene(std::int64_t count) {
  Scene scene;
  scene.materials = {alumina()};
  scene.box = scene.region = {{0, 0, 0}, {0.012, 0.012, 0.030}};
  scene.particle_diameter_m = 0.8e-3;
  scene.particle_temperature_K = 300;
  scene.feed.kind = FeedSettings::Kind::hopper;
  scene.feed.particle_count = count;
  scene.feed.fill_region = {{0, 0, 0.010}, {0.012, 0.012, 0.030}};
  scene.feed.remove_below_m = -0.020;
  scene.feed.velocity_m_s = 0.5;
  return scene;
}

TEST(HopperFeed, StartsDenseAndWithoutOverlap) {
  const Scene scene = hopper_scene(1500);
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  EXPECT_EQ(bed.size(), 1500u);
  EXPECT_GE(closest_pair(bed), 1 - 1e-12);
  double top = 0;
  for (const Vec3& p : bed.position_m) top = std::max(top, p.z);
  EXPECT_LT(top, 0.010 + 1500 * sphere_volume(0.4e-3) / (0.49 * 0.012 * 0.012));
}

TEST(HopperFeed, KeepsTheCountWhileSpheresLeave) {
  const Scene scene = hopper_scene(1500);
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  for (double& t : bed.temperature_K) t = 400;
  for (int k = 0; k < 400; ++k) {
    fly(bed, 5e-4);
    feed.update(bed);
    ASSERT_EQ(static_cast<std::int64_t>(bed.size()) + feed.totals().waiting, 1500);
    if (k % 20 == 0) {
      ASSERT_GE(closest_pair(bed), 1 - 1e-12);
    }
  }
  const FeedTotals& t = feed.totals();
  EXPECT_GT(t.removed, 3000);
  EXPECT_EQ(t.inserted - t.removed, static_cast<std::int64_t>(bed.size()) - 1500);
  // The first 1500 leave hot, the others as cold as they came.
  const double heat = 3984 * sphere_volume(0.4e-3) * 755;
  EXPECT_NEAR(t.heat_out_J, heat * (1500 * 400.0 + (t.removed - 1500) * 300.0), 1e-9 * t.heat_out_J);
  EXPECT_NEAR(t.heat_in_J, heat * t.inserted * 300.0, 1e-9 * t.heat_in_J);
}

TEST(HopperFeed, WhatFindsNoRoomWaits) {
  Scene scene = hopper_scene(20000);  // far more than the region holds
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  const auto at_start = static_cast<std::int64_t>(bed.size());
  EXPECT_LT(at_start, 20000);
  for (int k = 0; k < 200; ++k) {
    fly(bed, 5e-4);
    feed.update(bed);
    ASSERT_EQ(static_cast<std::int64_t>(bed.size()) + feed.totals().waiting, 20000);
  }
  EXPECT_GT(feed.totals().inserted, 1000);
  EXPECT_GE(closest_pair(bed), 1 - 1e-12);
}

TEST(HopperFeed, ABatchIsNotRefilled) {
  Scene scene = hopper_scene(3000);
  scene.feed.refill = false;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  for (int k = 0; k < 1000; ++k) fly(bed, 5e-4), feed.update(bed);
  EXPECT_EQ(bed.size(), 0u);
  EXPECT_EQ(feed.totals().removed, 3000);
}

TEST(HopperFeed, MassFlowCapsTheRefill) {
  Scene scene = hopper_scene(1500);
  scene.feed.mass_flow_kg_s = 1e-3;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  for (int k = 0; k < 400; ++k) fly(bed, 5e-4), feed.update(bed);
  const double mass = 3984 * sphere_volume(0.4e-3);
  EXPECT_NEAR(feed.totals().mass_in_kg, 1e-3 * 0.2, 1.5 * mass);
}

TEST(HopperFeed, ContinuesFromItsStateBitForBit) {
  const Scene scene = hopper_scene(1500);
  Feed straight(scene);
  Bed bed = empty_bed(scene);
  straight.start(bed);
  for (int k = 0; k < 200; ++k) fly(bed, 5e-4), straight.update(bed);

  Feed first(scene);
  Bed other = empty_bed(scene);
  first.start(other);
  for (int k = 0; k < 123; ++k) fly(other, 5e-4), first.update(other);
  Feed second(scene);
  second.load(first.save());
  for (int k = 123; k < 200; ++k) fly(other, 5e-4), second.update(other);
  EXPECT_EQ(bed.id, other.id);
  EXPECT_EQ(bed.position_m, other.position_m);
  EXPECT_EQ(straight.save().integers, second.save().integers);
  EXPECT_EQ(straight.save().reals, second.save().reals);
}

TEST(HopperFeed, RefusesARegionSmallerThanItsParticles) {
  Scene scene = hopper_scene(10);
  scene.feed.fill_region.max.x = 0.001;
  EXPECT_THROW(Feed{scene}, InputError);
}

TEST(HopperFeed, StartsFromParticlesThatAreThere) {
  const Scene scene = hopper_scene(2);
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  bed.add({0.006, 0.006, 0.005}, {}, 0.4e-3, 350);
  feed.start(bed);
  EXPECT_EQ(bed.size(), 1u);
  feed.update(bed);
  EXPECT_EQ(bed.size(), 2u);
}

}  // namespace
}  // namespace granrad
