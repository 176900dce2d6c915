// Requirement: a filled bed can be saved once and started from: the run that starts from its frame goes on
// bit for bit like the run that filled it, with the ids, velocities, springs and the places of the spheres to
// come. Planted errors seen to fail here: springs with walls dropped; spheres dropped at places keyed by a
// counter that begins anew.
#include <gtest/gtest.h>

#include <cstring>

#include "dem/engine_native.h"
#include "dem/feed/feed.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"
#include "tests/scene_text.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

constexpr std::int64_t steps_per_update = 100;
constexpr double step_s = 1e-5, filled_at_s = 0.12, end_s = 0.2;

/// A square shaft of 4 mm above a shutter. Some of the 600 spheres are poured in at the start, the others
/// dropped on top; after the shutter has opened, those that left are dropped again.
std::string shaft(const std::string& particles, double opens_at_s) {
  return R"(
[scene]
end_time_s = 1
gravity_m_s2 = [0, 0, -9.81]
)" + scene_text::alumina +
         R"([particles]
diameter_m = 0.8e-3
)" + particles +
         R"(
[box]
size_m = [4e-3, 4e-3, 22e-3]
[walls]
x_min = {role = "adiabatic"}
x_max = {role = "adiabatic"}
y_min = {role = "adiabatic"}
y_max = {role = "adiabatic"}
z_min = {role = "adiabatic", contact = false}
z_max = {role = "adiabatic", contact = false}
[[polygon]]
name = "shutter"
vertices_m = [[0, 0, 0], [4e-3, 0, 0], [4e-3, 4e-3, 0], [0, 4e-3, 0]]
role = "adiabatic"
opens_at_s = )" +
         std::to_string(opens_at_s) + R"(
[feed]
kind = "hopper"
particle_count = 600
velocity_m_s = 0.2
remove_below_m = -2e-3
[feed.fill_region]
min_m = [0, 0, 10e-3]
max_m = [4e-3, 4e-3, 22e-3]
[radiation]
source = "none"
)";
}

Bed first_bed(const Scene& scene, Feed& feed) {
  Bed bed = initial_bed(scene);
  feed.start(bed);
  return bed;
}

void run(const Scene& scene, Feed& feed, Bed& bed, double until_s) {
  const auto engine = make_native_engine(bed, scene.gravity_m_s2, step_s);
  while (bed.time_s < until_s - 0.5 * step_s) {
    feed.update(bed);
    engine->advance(bed, (static_cast<double>(bed.step + steps_per_update) - 0.5) * step_s);
  }
}

Scene scene_of(const std::string& text) {
  auto document = TomlDocument::from_string(text, "shaft.toml");
  return read_scene(document);
}

template <class T>
bool equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(FilledState, RunFromItsFrameGoesOnBitForBit) {
  const TemporaryFolder folder;
  const Scene filling = scene_of(shaft("", filled_at_s));
  Feed feed(filling);
  Bed straight = first_bed(filling, feed);
  EXPECT_LT(straight.size(), 600u);
  run(filling, feed, straight, filled_at_s);
  EXPECT_EQ(straight.size(), 600u);
  write_frame(folder / "filled.hdf", straight, {});
  run(filling, feed, straight, end_s);
  EXPECT_GT(straight.id.back(), 620);  // spheres left and came again

  const Scene flowing = scene_of(shaft("file = \"" + (folder / "filled.hdf").string() + "\"", 0));
  Feed later(flowing);
  Bed bed = first_bed(flowing, later);
  EXPECT_EQ(bed.time_s, 0);
  EXPECT_GT(bed.contacts.size(), 600u);
  run(flowing, later, bed, end_s - filled_at_s);
  EXPECT_EQ(bed.id, straight.id);
  EXPECT_TRUE(equal_bits(bed.position_m, straight.position_m));
  EXPECT_TRUE(equal_bits(bed.velocity_m_s, straight.velocity_m_s));
  EXPECT_TRUE(equal_bits(bed.angular_velocity_rad_s, straight.angular_velocity_rad_s));
  EXPECT_TRUE(equal_bits(bed.contacts, straight.contacts));
}

}  // namespace
}  // namespace granrad
