#include "raytrace/paths/clear_flights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/exact.h"

namespace granrad {

namespace {

struct Room {
  std::vector<WallPlane> planes;
  double volume_m3 = 0, surface_m2 = 0;
};

/// Of a convex room: pyramids over its walls about a point inside.
Room room_of(const Enclosure& enclosure) {
  Room room;
  const auto area = surface_areas(enclosure);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    room.planes.push_back(*plane_of(enclosure.walls[w]));
    const double wall_m2 = area[enclosure.sphere_count() + w];
    room.volume_m3 += room.planes[w].height(enclosure.centre_m[0]) * wall_m2 / 3;
    room.surface_m2 += wall_m2;
  }
  return room;
}

}  // namespace

ClearFlights::ClearFlights(const Enclosure& enclosure, const PathSurfaces& surfaces,
                           const EmbreeTracer& tracer, std::int64_t walks)
    : spheres_(static_cast<std::int32_t>(enclosure.sphere_count())) {
  constexpr double deepest = 1.5;
  if (!tracer.is_convex() || spheres_ == 0) return;
  const std::size_t walls = enclosure.walls.size(), count = enclosure.sphere_count();
  std::size_t radiating = 0;
  for (std::size_t w = 0; w < walls; ++w)
    radiating += surfaces.radiates(spheres_ + static_cast<std::int32_t>(w));
  if (radiating * count > static_cast<std::size_t>(walks) / 4) return;
  const Room room = room_of(enclosure);
  double discs = 0;
  for (const double r : enclosure.radius_m) discs += pi * r * r;
  const double kappa = discs / room.volume_m3;
  if (!(room.volume_m3 > 0) || kappa * 4 * room.volume_m3 / room.surface_m2 > deepest) return;

  weight_.assign(walls * count, 0);
  std::vector<double> height(walls);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& centre = enclosure.centre_m[i];
    const double r = enclosure.radius_m[i];
    const auto sphere = static_cast<std::int32_t>(i);
    for (std::size_t w = 0; w < walls; ++w) height[w] = room.planes[w].height(centre);
    if (!surfaces.radiates(sphere) || *std::min_element(height.begin(), height.end()) <= (1 + 1e-9) * r)
      continue;
    for (std::size_t w = 0; w < walls; ++w) {
      const std::int32_t wall = spheres_ + static_cast<std::int32_t>(w);
      if (!surfaces.radiates(wall)) continue;
      const auto c = static_cast<float>(std::exp(-1.5 * kappa * height[w]));
      weight_[w * count + i] = c;
      pairs_.push_back({wall, sphere,
                        c * surfaces.absorptivity(wall) * surfaces.absorptivity(sphere) * 4 * pi * r * r *
                            exact_sphere_wall(centre, enclosure.walls[w])});
    }
  }
}

}  // namespace granrad
