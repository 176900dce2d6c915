#include "raytrace/shading/near_spheres.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"

namespace granrad {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
bool Stretch::measure(const Neighbours& near, std::size_t begin, std::size_t count, float ax, float ay, float az,
                      float length) {
  constexpr float widest = 1.02f;  // radii differ by up to 1 %
  const float *x = &near.x[begin], *y = &near.y[begin], *z = &near.z[begin], *d2 = &near.distance2[begin];
  std::int32_t any = 0;
  for (std::size_t k = 0; k < count; ++k) {
    along[k] = x[k] * ax + y[k] * ay + z[k] * az;
    const float rho2 = d2[k] - along[k] * along[k];
    near_axis[k] =
        static_cast<std::int32_t>((rho2 < widest) & (along[k] > -0.5f) & (along[k] < length + 0.5f));
    any |= near_axis[k];
  }
  return any != 0;
}

namespace {

Reach reach_of(const Enclosure& enclosure) {
  constexpr double least = 6, negligible = 5e-4, most_neighbours = 20000;
  Box box{enclosure.centre_m[0], enclosure.centre_m[0]};
  double solid = 0, largest = 0;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const double r = enclosure.radius_m[i];
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], enclosure.centre_m[i][k] - r);
      box.max[k] = std::max(box.max[k], enclosure.centre_m[i][k] + r);
    }
    solid += sphere_volume(r);
    largest = std::max(largest, r);
  }
  const double phi = std::min(0.74, solid / box.volume());
  const double extinction = 1.5 * phi / (1 - phi), across = norm(box.size()) / (2 * largest);
  const double far = 1 - std::log(negligible) / extinction;
  const bool few = static_cast<double>(enclosure.sphere_count()) <= most_neighbours;
  const double reach =
      std::max(least, std::min({far, across, few ? across : std::cbrt(most_neighbours / (8 * phi))}));
  return {reach, reach < across ? std::exp(extinction * (1 - reach)) : 0};
}

std::vector<std::int32_t> numbers(std::size_t count) {
  std::vector<std::int32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

double largest_m(const Enclosure& enclosure) {
  return 2 * *std::max_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
}

}  // namespace

NearSpheres::NearSpheres(const Enclosure& enclosure)
    : enclosure_(enclosure),
      reach_(reach_of(enclosure)),
      grid_(enclosure.centre_m, numbers(enclosure.sphere_count()),
            (reach_.diameters + 0.1) * largest_m(enclosure), enclosure.box, enclosure.periodic) {}

Neighbours NearSpheres::of(std::int32_t i) const {
  struct Found {
    double distance;
    std::int32_t number;
    Vec3 place;
  };
  std::vector<Found> found;
  const double unit = 1 / (2 * enclosure_.radius_m[i]);
  grid_.visit_around(enclosure_.centre_m[i], [&](std::int32_t k, const Vec3& p) {
    if (k == i) return;
    const Vec3 place = (p - enclosure_.centre_m[i]) * unit;
    if (const double distance = norm(place); distance <= reach_.diameters + 0.1)
      found.push_back({distance, k, place});
  });
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
  });
  Neighbours near;
  for (const Found& f : found) {
    const double r = enclosure_.radius_m[f.number] * unit;
    near.place.push_back(f.place);
    near.distance.push_back(f.distance);
    near.number.push_back(f.number);
    near.x.push_back(static_cast<float>(f.place.x));
    near.y.push_back(static_cast<float>(f.place.y));
    near.z.push_back(static_cast<float>(f.place.z));
    near.distance2.push_back(static_cast<float>(f.distance * f.distance));
    near.radius2.push_back(static_cast<float>(r * r));
  }
  return near;
}

}  // namespace granrad
