#include "coupling/forecast/flow_speed.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "dem/base/clock.h"
#include "dem/engine_liggghts.h"
#include "dem/engine_native.h"

namespace granrad {

namespace {

constexpr double longest_s = 0.3;
constexpr double steps_at_once = 50;
constexpr std::int64_t most_steps_of_liggghts = 200;
constexpr double least_edge = 8, most_edge = 20;                 // spheres
constexpr double overlap = 1e-4;                                 // of a diameter: a light load
constexpr double of_free_fall = 0.1, most_of_a_diameter = 0.01;  // in a step

Bed cube_of_touching_spheres(const Scene& scene, double step_s, double particles) {
  const double diameter_m = scene.particle_diameter_m, apart_m = (1 - overlap) * diameter_m;
  const int edge = static_cast<int>(std::clamp(std::cbrt(particles), least_edge, most_edge));
  Bed bed;
  bed.materials = {scene.materials.front()};
  const double side_m = edge * apart_m;
  bed.box = {{0, 0, 0}, {side_m, side_m, side_m}};
  bed.periodic = {true, false, false};
  for (const Wall& wall : box_walls(bed.box))
    if (wall.name != "x_min" && wall.name != "x_max") bed.walls.push_back(wall);
  const double height_m = norm(scene.box.size());
  const double fall_m_s = of_free_fall * std::sqrt(2 * norm(scene.gravity_m_s2) * height_m);
  const Vec3 velocity{std::min(fall_m_s, most_of_a_diameter * diameter_m / step_s), 0, 0};
  for (int k = 0; k < edge * edge * edge; ++k) {
    const Vec3 place{k % edge + 0.5, k / edge % edge + 0.5, k / (edge * edge) + 0.5};
    bed.add(apart_m * place, velocity, diameter_m / 2, scene.particle_temperature_K);
  }
  return bed;
}

}  // namespace

double speed_in_contact(const Scene& scene, double step_s, double particles, int threads) {
  if (!computes_forces(scene.engine) || !(scene.particle_diameter_m > 0)) return 0;
  Bed bed = cube_of_touching_spheres(scene, step_s, particles);
  const auto engine = scene.engine == EngineKind::liggghts
                          ? make_liggghts_engine({}, step_s)
                          : make_native_engine(bed, {}, step_s, threads, scene.precision);
  engine->advance(bed, bed.time_s + steps_at_once * step_s);  // lists are made, threads started
  const double begin_s = monotonic_s();
  const std::int64_t first = bed.step;
  const auto goes_on = [&] {  // with LIGGGHTS all ranks go the same way
    return scene.engine == EngineKind::liggghts ? bed.step < first + most_steps_of_liggghts
                                                : monotonic_s() - begin_s < longest_s;
  };
  while (goes_on()) engine->advance(bed, bed.time_s + steps_at_once * step_s);
  return static_cast<double>(bed.size()) * static_cast<double>(bed.step - first) / (monotonic_s() - begin_s);
}

}  // namespace granrad
