#pragma once
#include <cmath>

#include "dem/base/constants.h"
#include "dem/scene/scene.h"
#include "tests/alumina.h"

namespace granrad::testing_scenes {

/// The paper's plug flow: alumina of 0.8 mm in the channel 10 x 4 x `height` mm at 1.59 g/s.
inline Scene plug_scene(double solid_fraction, double height_m = 0.050) {
  Scene scene;
  scene.materials = {alumina()};
  scene.box = scene.region = {{0, 0, 0}, {0.010, 0.004, height_m}};
  for (const Wall& wall : box_walls(scene.box)) scene.walls.push_back(wall);
  scene.box_wall_count = 6;
  scene.walls[4].contact = scene.walls[5].contact = false;
  scene.particle_diameter_m = 0.8e-3;
  scene.particle_temperature_K = 300;
  scene.feed.kind = FeedSettings::Kind::plug;
  scene.feed.solid_fraction = solid_fraction;
  scene.feed.mass_flow_kg_s = 1.59e-3;
  scene.feed.transverse_velocity_std_m_s = 1e-3;
  return scene;
}

/// Bed at time 0 with the scene's walls and materials and no particles.
inline Bed empty_bed(const Scene& scene) {
  Bed bed;
  bed.materials = scene.materials;
  bed.walls = scene.walls;
  bed.periodic = scene.periodic;
  bed.box = scene.box;
  return bed;
}

inline double solid_fraction(const Bed& bed, const Box& box) {
  double volume = 0;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (box.contains(bed.position_m[i])) volume += sphere_volume(bed.radius_m[i]);
  return volume / box.volume();
}

/// Smallest (distance / contact distance) over all pairs, by brute force.
inline double closest_pair(const Bed& bed) {
  double closest = 1e9;
  for (std::size_t i = 0; i < bed.size(); ++i)
    for (std::size_t j = i + 1; j < bed.size(); ++j) {
      const double distance = norm(bed.position_m[j] - bed.position_m[i]);
      closest = std::min(closest, distance / (bed.radius_m[i] + bed.radius_m[j]));
    }
  return closest;
}

/// Straight flight instead of an engine.
inline void fly(Bed& bed, double seconds) {
  for (std::size_t i = 0; i < bed.size(); ++i) bed.position_m[i] += bed.velocity_m_s[i] * seconds;
  bed.time_s += seconds;
}

}  // namespace granrad::testing_scenes
