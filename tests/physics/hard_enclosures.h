#pragma once
#include <cstdint>
#include <vector>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/exact.h"
#include "raytrace/rays/ray_rows.h"
#include "tests/enclosures.h"

namespace granrad::hard {

inline constexpr double r = 4e-4;

inline TraceOptions rays(double n, Sampling sampling = Sampling::plain, std::uint64_t seed = 1) {
  TraceOptions o;
  o.rays_per_particle = n;
  o.sampling = sampling;
  o.seed = seed;
  return o;
}

/// Rays of some surfaces only.
inline HitCounts trace_only(const Enclosure& e, const std::vector<std::int64_t>& count) {
  const EmbreeTracer tracer(e);
  return trace_rows(e, surface_areas(e), count, rays(0), [&](const EmittedRay& ray) {
    const Hit hit = tracer.first_hit(ray.start.origin_m, ray.start.direction, ray.surface, ray.start.normal);
    return RayEnd{hit.surface, hit.distance_m};
  });
}

inline HitCounts trace_first_sphere(const Enclosure& e, std::int64_t n) {
  std::vector<std::int64_t> count(e.surface_count(), 0);
  count[0] = n;
  return trace_only(e, count);
}

/// Random spheres, centres in the box; they overlap each other and the walls as they like.
inline Enclosure random_bed(const Box& box, std::size_t n, double radius, std::uint64_t seed) {
  std::vector<Vec3> centre;
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = random_uniform2(seed, i, 0), b = random_uniform2(seed, i, 1);
    const Vec3 size = box.size();
    centre.push_back({box.min.x + a[0] * size.x, box.min.y + a[1] * size.y, box.min.z + b[0] * size.z});
  }
  return boxed(spheres_in_open_space(centre, std::vector<double>(n, radius)), box);
}

/// Spheres that do not overlap, one by one where there is room, in a box that repeats in x, y and z.
inline std::vector<Vec3> separate_spheres(double length, std::size_t n, double radius) {
  std::vector<Vec3> centre;
  for (std::uint64_t k = 0; centre.size() < n; ++k) {
    const auto a = random_uniform2(31, k, 0), b = random_uniform2(31, k, 1);
    const Vec3 p{a[0] * length, a[1] * length, b[0] * length};
    const auto near = [&](const Vec3& q) {
      Vec3 d = p - q;
      for (int axis = 0; axis < 3; ++axis) d[axis] -= length * std::round(d[axis] / length);
      return norm(d) < 2 * radius;
    };
    if (std::none_of(centre.begin(), centre.end(), near)) centre.push_back(p);
  }
  return centre;
}

}  // namespace granrad::hard
