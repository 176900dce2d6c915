#include <fmt/format.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/rays/error_target.h"

namespace granrad {

namespace {

constexpr int most_reflections = 1 << 20;

void require_emissivities(const Enclosure& enclosure, const std::vector<double>& emissivity) {
  if (emissivity.size() != enclosure.surface_count())
    throw InputError(
        fmt::format("emissivity: {} values (must be one for each of the {} surfaces, surroundings last)",
                    emissivity.size(), enclosure.surface_count()));
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < emissivity.size(); ++i)
    if (!(emissivity[i] >= 0 && emissivity[i] <= 1))
      problems.push_back(fmt::format("emissivity of surface {} = {} (must be in [0, 1])", i, emissivity[i]));
  if (!problems.empty()) throw InputError(problems);
}

/// Follows one bundle from its first hit to where it is absorbed; its random numbers are a function of the
/// ray.
class Bundle {
 public:
  Bundle(const EmbreeTracer& tracer, const std::vector<double>& emissivity, std::uint64_t seed,
         const EmittedRay& ray)
      : tracer_(tracer),
        emissivity_(emissivity),
        seed_(seed ^ 0x7265666c656374ull),
        stream_(static_cast<std::uint64_t>(static_cast<std::uint32_t>(ray.replicate)) << 32 |
                static_cast<std::uint32_t>(ray.surface)),
        counter_(ray.ray << 20) {}

  /// -1: leaked, or never absorbed.
  std::int32_t absorbed_by(Hit hit) {
    const auto open = static_cast<std::int32_t>(emissivity_.size()) - 1;
    for (int k = 0; k < most_reflections && hit.surface >= 0 && hit.surface != open; ++k) {
      const double absorptance = emissivity_[static_cast<std::size_t>(hit.surface)];
      if (absorptance == 1) return hit.surface;
      const auto bits = random_bits(seed_, stream_, counter_++);
      const auto uniform = [&](int n) { return (bits[static_cast<std::size_t>(n)] + 0.5) * 0x1.0p-32; };
      if (uniform(0) < absorptance) return hit.surface;
      hit = tracer_.first_hit(hit.position_m, cosine_direction(hit.normal, uniform(1), uniform(2)),
                              hit.surface, hit.normal);
    }
    return hit.surface == open ? open : -1;
  }

 private:
  const EmbreeTracer& tracer_;
  const std::vector<double>& emissivity_;
  std::uint64_t seed_, stream_, counter_;
};

}  // namespace

HitCounts trace_total_exchange(const Enclosure& enclosure, const std::vector<double>& emissivity,
                               const TraceOptions& options, TraceReport* report) {
  require_emissivities(enclosure, emissivity);
  std::vector<double> emitting_area = surface_areas(enclosure);
  for (std::size_t i = 0; i < emitting_area.size(); ++i) emitting_area[i] *= emissivity[i];
  if (std::all_of(emitting_area.begin(), emitting_area.end(), [](double a) { return a == 0; }))
    throw InputError("emissivity: zero everywhere (nothing emits; give a surface a positive one)");
  const EmbreeTracer tracer(enclosure, options.threads);
  const auto follow = [&](const EmittedRay& ray) {
    const Hit hit = tracer.first_hit(ray.start.origin_m, ray.start.direction, ray.surface, ray.start.normal);
    return RayEnd{Bundle(tracer, emissivity, options.seed, ray).absorbed_by(hit), hit.distance_m};
  };
  return trace_to_target(enclosure, emitting_area, options, follow, report);
}

}  // namespace granrad
