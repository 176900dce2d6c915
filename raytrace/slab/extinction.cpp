#include "raytrace/slab/extinction.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/rays/emission.h"

namespace granrad {

namespace {

constexpr int batches = 16, distances = 40;
constexpr double longest_diameters = 10;

double uniform(std::uint32_t bits) {
  return (bits + 0.5) * 0x1.0p-32;
}

Vec3 isotropic(double a, double b) {
  const double z = 2 * a - 1, s = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * pi * b;
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// Where rays may start: the box along periodic directions, the extent of the centres along the others.
Box start_box(const Enclosure& enclosure) {
  Box box{enclosure.centre_m.front(), enclosure.centre_m.front()};
  for (const Vec3& p : enclosure.centre_m)
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], p[k]);
      box.max[k] = std::max(box.max[k], p[k]);
    }
  for (int k = 0; k < 3; ++k)
    if (enclosure.periodic[k]) box.min[k] = enclosure.box.min[k], box.max[k] = enclosure.box.max[k];
  return box;
}

struct Batch {
  double length_m = 0, cosine = 0;
  std::int64_t hits = 0, starts = 0, inside = 0;
  std::vector<double> at_risk = std::vector<double>(distances, 0.0),
                      ended = at_risk;  ///< by interval of length
};

class Walk {
 public:
  Walk(const Enclosure& enclosure, const ExtinctionRequest& request, double diameter)
      : tracer_(enclosure, request.threads),
        spheres_(static_cast<std::int32_t>(enclosure.sphere_count())),
        box_(start_box(enclosure)),
        seed_(request.seed ^ 0x657874696e637400ull),
        step_m_(longest_diameters * diameter / distances) {}

  void one(Batch& batch, std::uint64_t stream, std::uint64_t ray) const {
    const auto a = random_bits(seed_, stream, 2 * ray), b = random_bits(seed_, stream, 2 * ray + 1);
    const Vec3 size = box_.size();
    const Vec3 start{box_.min.x + size.x * uniform(a[0]), box_.min.y + size.y * uniform(a[1]),
                     box_.min.z + size.z * uniform(a[2])};
    const Vec3 direction = isotropic(uniform(a[3]), uniform(b[0]));
    const Hit hit = tracer_.first_hit(start, direction, -1);
    ++batch.starts;
    if (hit.surface >= 0 && hit.surface < spheres_ && hit.distance_m <= 0) return void(++batch.inside);
    const bool sphere = hit.surface >= 0 && hit.surface < spheres_;
    if (!std::isfinite(hit.distance_m)) return;  // nothing to meet: no length
    batch.length_m += hit.distance_m;
    const double last = hit.distance_m / step_m_;
    for (int k = 0; k < distances && k <= last; ++k) {
      const bool ends = last < k + 1;
      batch.at_risk[k] += ends && !sphere ? 0.5 : 1;  // hidden by a wall half way through
      batch.ended[k] += ends && sphere;
    }
    if (!sphere) return;
    ++batch.hits;
    batch.cosine += dot(direction, cosine_direction(hit.normal, uniform(b[1]), uniform(b[2])));
  }
  double step_m() const { return step_m_; }

 private:
  EmbreeTracer tracer_;
  std::int32_t spheres_;
  Box box_;
  std::uint64_t seed_;
  double step_m_;
};

template <class Get>
Estimate over(const std::vector<Batch>& all, Get get) {
  double sum = 0, squares = 0;
  for (const auto& b : all) sum += get(b);
  const double mean = sum / batches;
  for (const auto& b : all) squares += (get(b) - mean) * (get(b) - mean);
  return {mean, std::sqrt(squares / (batches * (batches - 1)))};
}

}  // namespace

Extinction measure_extinction(const Enclosure& enclosure, const ExtinctionRequest& request) {
  if (enclosure.sphere_count() == 0) throw InputError("there are no particles to meet");
  double diameter = 0;
  for (double r : enclosure.radius_m) diameter += 2 * r / static_cast<double>(enclosure.sphere_count());
  const Walk walk(enclosure, request, diameter);
  std::vector<Batch> all(batches);
#pragma omp parallel for schedule(dynamic)
  for (int b = 0; b < batches; ++b)
    for (std::int64_t k = 0; k < request.rays / batches; ++k)
      walk.one(all[b], static_cast<std::uint64_t>(b), static_cast<std::uint64_t>(k));
  for (const auto& b : all)
    if (b.hits == 0)
      throw InputError(
          advised("hardly a ray starts in the void and meets a sphere", "trace more rays, or check the bed"));
  Extinction result;
  result.rays = request.rays;
  result.coefficient_per_m =
      over(all, [](const Batch& b) { return static_cast<double>(b.hits) / b.length_m; });
  const double path = 1 / result.coefficient_per_m.value;
  const double relative = result.coefficient_per_m.error / result.coefficient_per_m.value;
  result.mean_free_path_m = {path, path * relative};
  result.mean_free_path_d = {path / diameter, path / diameter * relative};
  result.scattering_cosine = over(all, [](const Batch& b) { return b.cosine / static_cast<double>(b.hits); });
  result.solid_fraction_void = over(all, [](const Batch& b) {
                                 return static_cast<double>(b.inside) / static_cast<double>(b.starts);
                               }).value;
  std::vector<double> passed(batches, 1.0);
  for (int k = 0; k < distances; ++k) {
    for (int b = 0; b < batches; ++b)
      passed[b] *= all[b].at_risk[k] > 0 ? 1 - all[b].ended[k] / all[b].at_risk[k] : 0;
    const auto t = over(all, [&](const Batch& b) { return passed[&b - all.data()]; });
    result.distance_m.push_back((k + 1) * walk.step_m());
    result.transmittance.push_back(t.value);
    result.transmittance_error.push_back(t.error);
  }
  return result;
}

}  // namespace granrad
