#include "coupling/simulation/step_limits.h"

#include <algorithm>
#include <cmath>

#include "coupling/heat/heat_step.h"
#include "dem/base/constants.h"
#include "dem/step_limit.h"

namespace granrad {

namespace {

constexpr double normal_deviates = 4;        // of the transverse velocity, both partners
constexpr double smallest_speed_m_s = 1e-3;  // a bed at rest still settles

/// Of a fall through all of the box and the walls, whichever way gravity points, (m/s)^2: 2 sum |g_k| L_k.
double falling_speed_squared(const Scene& scene) {
  Box all = scene.box;
  for (const Wall& wall : scene.walls)
    for (const Vec3& vertex : wall.vertices) all.include(vertex);
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::abs(scene.gravity_m_s2[axis]) * all.size()[axis];
  return 2 * sum;
}

double spread_of_speed_m_s(const Bed& bed) {
  if (bed.size() == 0) return 0;
  Vec3 mean{};
  for (const Vec3& v : bed.velocity_m_s) mean += v;
  mean *= 1.0 / static_cast<double>(bed.size());
  double largest = 0;
  for (const Vec3& v : bed.velocity_m_s) largest = std::max(largest, norm(v - mean));
  return largest;
}

double impact_speed_m_s(const Scene& scene, const Bed& bed) {
  const double fall = std::sqrt(falling_speed_squared(scene));
  const double jostle = std::sqrt(2.0) * normal_deviates * scene.feed.transverse_velocity_std_m_s;
  return std::max(smallest_speed_m_s, std::max(2 * spread_of_speed_m_s(bed), jostle) + fall);
}

double smallest_radius_m(const Scene& scene, const Bed& bed) {
  double smallest = scene.particle_diameter_m > 0 ? scene.particle_diameter_m / 2 : infinity;
  for (double radius : bed.radius_m) smallest = std::min(smallest, radius);
  return smallest;
}

/// The bed, or one particle of the scene where the bed is still empty.
double radiation_limit_s(const Scene& scene, const Bed& bed) {
  // what is to come counts too: the feed's particles may be hotter than the bed
  double hottest = scene.feed.kind == FeedSettings::Kind::none ? 0 : scene.particle_temperature_K;
  for (const Wall& wall : scene.walls) hottest = std::max(hottest, wall.course.empty() ? 0 : hottest_K(wall));
  if (bed.size() > 0) return explicit_radiation_fraction * radiation_time_constant_s(bed, hottest);
  Bed lone = bed;
  lone.add(scene.box.min, {}, scene.particle_diameter_m / 2, scene.particle_temperature_K);
  return explicit_radiation_fraction * radiation_time_constant_s(lone, hottest);
}

double largest_speed_m_s(const Scene& scene, const Bed& bed) {
  double largest = scene.feed.velocity_m_s;
  for (const Vec3& v : bed.velocity_m_s) largest = std::max(largest, norm(v));
  return largest;
}

}  // namespace

double radiation_interval_s(const Case& c, const StepLimits& limits) {
  constexpr double part_of_a_diameter = 0.5;
  if (c.heat.radiation.every_s > 0) return c.heat.radiation.every_s;
  const double row = c.heat.output.every_s;
  const double longest = std::min({row, limits.radiation_s, part_of_a_diameter * limits.motion_s});
  return row / std::ceil(row / longest * (1 - 1e-9));
}

StepLimits step_limits(const Case& c, const Bed& bed) {
  const Scene& scene = c.flow;
  const double radius = smallest_radius_m(scene, bed);
  StepLimits limits{};
  limits.impact_speed_m_s = impact_speed_m_s(scene, bed);
  limits.rayleigh_time_s = limits.hertz_time_s = limits.dem_s = infinity;
  limits.radiation_s = limits.motion_s = infinity;
  if (!std::isfinite(radius)) return limits;
  if (computes_forces(scene.engine)) {
    for (const Material& material : scene.materials) {
      limits.rayleigh_time_s = std::min(limits.rayleigh_time_s, rayleigh_time_s(material, radius));
      limits.hertz_time_s =
          std::min(limits.hertz_time_s, hertz_time_s(material, radius, limits.impact_speed_m_s));
    }
    limits.dem_s = std::min(rayleigh_share * limits.rayleigh_time_s, hertz_share * limits.hertz_time_s);
  }
  if (scene.engine != EngineKind::none) {
    const double speed = largest_speed_m_s(scene, bed);
    if (speed > 0) limits.motion_s = 2 * radius / speed;
  }
  if (c.heat.radiation.kind != RadiationKind::none) limits.radiation_s = radiation_limit_s(scene, bed);
  return limits;
}

}  // namespace granrad
