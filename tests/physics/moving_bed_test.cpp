// Requirement: the moving beds of data/scenes fill, open and flow as LIGGGHTS and the paper say: mass
// flow 5.9-6.1, 3.3-3.5 and 1.1-1.5 g/s for outlets 4, 3 and 2 x 4 mm, channel solid fraction 0.540-0.560,
// wall layer at 0.72-0.82 of the centre's speed, and stay steady because what leaves comes back on top.
// Wall layer: centres within d of a hot wall. Centre: within d/2 of the middle plane and 2.5 d of the axis,
// so away from all four walls. The LIGGGHTS snapshot of the 4 x 4 outlet gives 0.755 by this measure.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "dem/engine_native.h"
#include "dem/feed/feed.h"
#include "tests/feed_scenes.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

struct Flow {
  double mass_flow_g_s, solid_fraction, wall_over_centre;
  std::int64_t count, waiting;
};

/// Runs a scene to `end_s` and averages from `from_s` on.
Flow run(const std::string& name, double from_s, double end_s) {
  auto document = TomlDocument::from_file(granrad::source_dir() + "/data/scenes/" + name + ".toml");
  const Scene scene = read_scene(document);
  Feed feed(scene);
  Bed bed = initial_bed(scene);
  feed.start(bed);
  const auto engine = make_native_engine(bed, scene.gravity_m_s2, scene.step_s);
  Box middle = scene.box;
  middle.min.z += 0.2 * scene.box.size().z, middle.max.z -= 0.2 * scene.box.size().z;
  const double d = scene.particle_diameter_m;
  const double axis_x = 0.5 * (middle.min.x + middle.max.x);
  double fraction = 0, wall = 0, centre = 0, start_s = 0, mass_before = 0;
  std::int64_t samples = 0, at_wall = 0, at_centre = 0;
  while (bed.time_s < end_s) {
    feed.update(bed);
    engine->advance(bed, (static_cast<double>(bed.step) + 99.5) * scene.step_s);
    if (bed.time_s < from_s) {
      start_s = bed.time_s, mass_before = feed.totals().mass_out_kg;
      continue;
    }
    if (bed.step % 1000 != 0) continue;
    fraction += testing_scenes::solid_fraction(bed, middle), ++samples;
    for (std::size_t i = 0; i < bed.size(); ++i) {
      const Vec3& p = bed.position_m[i];
      if (!middle.contains(p)) continue;
      const double from_wall = std::min(p.y - middle.min.y, middle.max.y - p.y);
      if (from_wall < d) wall += bed.velocity_m_s[i].z, ++at_wall;
      if (from_wall > 0.5 * middle.size().y - 0.5 * d && std::abs(p.x - axis_x) < 2.5 * d)
        centre += bed.velocity_m_s[i].z, ++at_centre;
    }
  }
  const Flow flow{1e3 * (feed.totals().mass_out_kg - mass_before) / (bed.time_s - start_s),
                  fraction / samples, wall / at_wall / (centre / at_centre),
                  static_cast<std::int64_t>(bed.size()), feed.totals().waiting};
  std::printf("%s: %.3f g/s, solid fraction %.4f, wall / centre %.3f, %ld particles, %ld waiting\n",
              name.c_str(), flow.mass_flow_g_s, flow.solid_fraction, flow.wall_over_centre,
              static_cast<long>(flow.count), static_cast<long>(flow.waiting));
  return flow;
}

void expect_flow(const Flow& flow, double least_g_s, double most_g_s) {
  EXPECT_GT(flow.mass_flow_g_s, least_g_s);
  EXPECT_LT(flow.mass_flow_g_s, most_g_s);
  EXPECT_GT(flow.solid_fraction, 0.540);
  EXPECT_LT(flow.solid_fraction, 0.560);
  EXPECT_GT(flow.wall_over_centre, 0.72);
  EXPECT_LT(flow.wall_over_centre, 0.82);
  EXPECT_EQ(flow.count + flow.waiting, 13576);
}

// By the scatter of its 50 ms means the flow over 1 s is uncertain by 0.04 g/s (6.11 was met), over 3 s by
// 0.025.
TEST(MovingBed, LongOutlet4x4) {
  expect_flow(run("moving_bed_4x4", 2.0, 5.0), 5.9, 6.1);
}
TEST(MovingBed, LongOutlet3x4) {
  expect_flow(run("moving_bed_3x4", 1.2, 2.5), 3.3, 3.5);
}
TEST(MovingBed, LongOutlet2x4) {
  expect_flow(run("moving_bed_2x4", 1.5, 3.5), 1.1, 1.5);
}

/// Volume of the part of the bed between two heights.
double solid_volume(const Bed& bed, double low, double high) {
  const auto below = [](double x) {  // of a unit sphere, under the plane at x
    x = std::clamp(x, -1.0, 1.0);
    return pi * (2.0 / 3 + x - x * x * x / 3);
  };
  double sum = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const double r = bed.radius_m[i], z = bed.position_m[i].z;
    sum += r * r * r * (below((high - z) / r) - below((low - z) / r));
  }
  return sum;
}

/// Solid fractions of slices of the feed hopper, by their lower end (data/reference/liggghts_feed_fill.csv).
std::map<double, double> filled_feed_of_liggghts() {
  std::ifstream in(granrad::source_dir() + "/data/reference/liggghts_feed_fill.csv");
  EXPECT_TRUE(in);
  std::map<double, double> slices;
  for (std::string line; std::getline(in, line);)
    if (std::isdigit(line[0])) slices[std::stod(line)] = std::stod(line.substr(line.find(',') + 1));
  return slices;
}

// The feed hopper alone, filled over a shutter at its foot as in LIGGGHTS: the same number of spheres,
// loosely strewn, falling at 0.4 m/s.
TEST(MovingBed, LongFilledFeedIsAsDenseAsInLiggghts) {
  auto document = TomlDocument::from_file(granrad::source_dir() + "/data/scenes/moving_bed_4x4.toml");
  Scene scene = read_scene(document);
  Wall shutter;
  shutter.vertices = {
      {-5.5e-3, -2.5e-3, 0.05}, {5.5e-3, -2.5e-3, 0.05}, {5.5e-3, 2.5e-3, 0.05}, {-5.5e-3, 2.5e-3, 0.05}};
  scene.walls.push_back(shutter);
  scene.feed.fill_region = {{-0.0144, -0.0114, 0.0705}, {0.0144, 0.0114, 0.0985}};
  scene.feed.solid_fraction = 0.2;
  Feed feed(scene);
  Bed bed = initial_bed(scene);
  feed.start(bed);
  ASSERT_EQ(bed.size(), 13576u);
  make_native_engine(bed, scene.gravity_m_s2, scene.step_s)->advance(bed, 0.22);
  for (const auto& [low, want] : filled_feed_of_liggghts()) {
    const auto area = [](double z) { return 4 * (5e-3 + 0.5 * (z - 0.05)) * (2e-3 + 0.5 * (z - 0.05)); };
    const double thickness = 2e-3, high = low + thickness;
    const double volume = thickness / 6 * (area(low) + 4 * area(low + 0.5 * thickness) + area(high));
    const double found = solid_volume(bed, low, high) / volume;
    std::printf("z = %.0f mm: solid fraction %.4f, LIGGGHTS %.4f\n", 1e3 * low, found, want);
    EXPECT_NEAR(found, want, 0.01) << low;
  }
}

TEST(MovingBed, LongMustardSeedFlows) {
  const Flow flow = run("moving_bed_mustard", 2.0, 4.0);
  EXPECT_GT(flow.mass_flow_g_s, 0.1);
  EXPECT_GT(flow.solid_fraction, 0.5);
  EXPECT_LT(flow.solid_fraction, 0.6);
  EXPECT_EQ(flow.count + flow.waiting, 10840);
}

}  // namespace
}  // namespace granrad
