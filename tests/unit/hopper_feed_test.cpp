// Requirement: the hopper feed starts with the asked number of spheres, replaces those that leave by cold
// ones that never overlap, carries the rest when there is no room, and continues bit for bit from its state.
// Planted errors seen to fail here: newcomers blind to each other, a batch refilled,
// counter not restored.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
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

// From an empty chute N(t) is the rate times t, for number and mass alike, and ends with the count.
TEST(HopperFeed, PoursAtARateFromEmpty) {
  Scene scene = hopper_scene(30);
  scene.feed.rate_1_s = 200;
  scene.feed.refill = false;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  feed.start(bed);
  EXPECT_EQ(bed.size(), 0u);
  for (int k = 1; k <= 400; ++k) {
    fly(bed, 5e-4);
    feed.update(bed);
    ASSERT_EQ(feed.totals().inserted, std::min<std::int64_t>(30, k / 10)) << k;
  }
  EXPECT_GE(closest_pair(bed), 1 - 1e-12);
}

// One sphere, a few in a layer thinner than a packing, and as many as fill a wide region: all start.
TEST(HopperFeed, StartsAnyNumber) {
  for (const std::int64_t count : {1, 2, 7, 40, 100, 600}) {
    Scene scene = hopper_scene(count);
    scene.feed.fill_region = {{0, 0, 0.010}, {0.012, 0.012, 0.018}};
    Feed feed(scene);
    Bed bed = empty_bed(scene);
    feed.start(bed);
    EXPECT_EQ(static_cast<std::int64_t>(bed.size()), count);
    EXPECT_GE(closest_pair(bed), 1 - 1e-12);
    for (const Vec3& p : bed.position_m) EXPECT_LE(p.z, 0.018 - 0.4e-3 + 1e-12);
  }
}

// A grain that has crossed a period is where its image is (to plant: positions as they stand, it is not seen).
TEST(HopperFeed, SeesGrainsAcrossAPeriod) {
  Scene scene = hopper_scene(400);
  scene.periodic = {true, true, false};
  scene.feed.rate_1_s = 1e9;
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  bed.box = scene.box;
  bed.periodic = scene.periodic;
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 12; ++j)
      bed.add({0.0005 + 0.001 * k - 0.012 * (k % 3), 0.0005 + 0.001 * j + 0.012 * (j % 2), 0.0105}, {}, 4e-4,
              300);
  bed.time_s = 1e-6;
  feed.update(bed);
  ASSERT_GT(bed.size(), 144u);
  double closest = 1e300;
  for (std::size_t i = 0; i < bed.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(closest, norm(nearest_image(bed, bed.position_m[i] - bed.position_m[j])) / 8e-4);
  EXPECT_GE(closest, 1 - 1e-9);
}

// What comes into a [[remove]] place leaves with its mass and heat, by the heat capacity of its own material.
TEST(Removal, CountsWhatLeaves) {
  Scene scene = hopper_scene(1);
  scene.feed = {};
  Material steel = alumina();
  steel.density_kg_m3 = 7800, steel.specific_heat_J_kgK = 500;
  scene.materials.push_back(steel);
  scene.removals = {{{-infinity, -infinity, -infinity}, {infinity, infinity, -0.01}},
                    {{0.1, 0, 0}, {0.2, 1, 1}}};
  Feed feed(scene);
  Bed bed = empty_bed(scene);
  bed.materials = scene.materials;
  bed.add({0.005, 0.005, -0.02}, {}, 4e-4, 400);  // below the plane
  bed.add({0.15, 0.5, 0.5}, {}, 4e-4, 600, 1);    // in the box, of steel
  bed.add({0.005, 0.005, 0.02}, {}, 4e-4, 300);   // stays
  feed.update(bed);
  EXPECT_EQ(bed.size(), 1u);
  EXPECT_EQ(feed.totals().removed, 2);
  const double volume = sphere_volume(4e-4), first = 3984 * volume * 755, second = 7800 * volume * 500;
  EXPECT_NEAR(feed.totals().heat_capacity_out_J_K, first + second, 1e-12 * second);
  EXPECT_NEAR(feed.totals().heat_out_J, 400 * first + 600 * second, 1e-12 * 600 * second);
}

}  // namespace
}  // namespace granrad
