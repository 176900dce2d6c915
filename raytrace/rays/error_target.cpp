#include "raytrace/rays/error_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "raytrace/rays/ray_allocation.h"

namespace granrad {

namespace {

using Clock = std::chrono::steady_clock;

double sum(const std::vector<std::int64_t>& rays) {
  return std::accumulate(rays.begin(), rays.end(), 0.0);
}

void refuse_out_of_reach(const std::vector<std::int64_t>& wanted, double error, const TraceReport& report) {
  if (*std::max_element(wanted.begin(), wanted.end()) <= most_rays_of_a_surface) return;
  throw ThresholdMissed(
      advised(fmt::format("error = {:.3g} (reached {:.3g} with {:.2g} rays, would need {:.2g})", error,
                          report.error, static_cast<double>(report.rays), sum(wanted)),
              "ask for less"));
}

}  // namespace

HitCounts trace_to_target(const Enclosure& enclosure, const std::vector<double>& area_m2,
                          const TraceOptions& options, const std::function<RayEnd(const EmittedRay&)>& follow,
                          TraceReport* report) {
  constexpr double pilot_rays = 256, aim = 0.95, least_growth = 1.2, most_growth = 4;
  const auto start = Clock::now();
  const StatedQuantity quantity = stated_quantity(enclosure, options.hot_walls);
  const bool by_error = options.target_error > 0 && enclosure.sphere_count() > 0;
  auto rays = rays_per_surface(enclosure, area_m2, by_error ? pilot_rays : options.rays_per_particle);
  TraceReport spent;
  for (;;) {
    HitCounts counts = trace_rows(enclosure, area_m2, rays, options, follow);
    spent.rays += std::accumulate(counts.launched.begin(), counts.launched.end(), std::int64_t{0});
    ++spent.rounds;
    if (!by_error && !report) return counts;
    spent.error = particle_sums(counts, quantity).relative_error(quantity.relative_to_rms);
    spent.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!by_error || spent.error <= options.target_error) {
      if (report) *report = spent;
      return counts;
    }
    auto wanted = rays_for_error(counts, quantity, aim * options.target_error);
    refuse_out_of_reach(wanted, options.target_error, spent);
    const double growth = sum(wanted) / sum(rays), allowed = std::clamp(growth, least_growth, most_growth);
    if (growth != allowed)
      wanted = rays_for_error(counts, quantity, aim * options.target_error * std::sqrt(growth / allowed));
    rays = std::move(wanted);
  }
}

}  // namespace granrad
