#include "coupling/heat/harmonic_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "coupling/heat/harmonic_radiosity.h"
#include "dem/base/error.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/same_geometry.h"

namespace granrad {

namespace {

/// Runs work(0 .. count - 1) in parallel and hands on the first error.
template <class Work>
void in_parallel(int count, int threads, Work work) {
  std::exception_ptr error;
#pragma omp parallel for num_threads(line_threads(threads)) schedule(dynamic)
  for (int k = 0; k < count; ++k) try {
      work(k);
    } catch (...) {
#pragma omp critical
      error = std::current_exception();
    }
  if (error) std::rethrow_exception(error);
}

/// Patches half a small sphere's diameter long; without spheres 20 across the shortest wall.
double patch_size(const Enclosure& enclosure) {
  constexpr double patches_across = 20;
  if (!enclosure.radius_m.empty())
    return *std::min_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
  double shortest = 1e300;
  for (const Wall& wall : enclosure.walls)
    for (std::size_t k = 0; k < wall.vertices.size(); ++k)
      shortest = std::min(shortest, norm(wall.vertices[(k + 1) % wall.vertices.size()] - wall.vertices[k]));
  return shortest / patches_across;
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

double error_of_mean(const std::vector<double>& v) {
  const double n = static_cast<double>(v.size()), m = mean(v);
  double squares = 0;
  for (double x : v) squares += (x - m) * (x - m);
  return std::sqrt(squares / (n * (n - 1)));
}

}  // namespace

void HarmonicSource::prepare(const Enclosure& enclosure) {
  if (prepared_ && same_geometry(enclosure, enclosure_)) return;
  prepared_ = false;
  const WallPatches patches(enclosure.walls, patch_size(enclosure));
  LineOptions options = options_;
  options.seed += geometry_key(enclosure);
  options.memory_limit_bytes /= static_cast<std::size_t>(options.replicates);
  replicates_.assign(options.replicates, {});
  in_parallel(options.replicates, options.threads, [&](int r) {
    replicates_[r] = sweep_exchange_moments(enclosure, options, order_, patches, r);
  });
  enclosure_ = enclosure;
  prepared_ = true;
}

RadiativeHeat HarmonicSource::net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                       std::uint64_t /*update*/) {
  prepare(enclosure);
  if (std::count(state.excluded.begin(), state.excluded.end(), 0) !=
      static_cast<std::ptrdiff_t>(state.excluded.size()))
    throw InputError(
        advised("radiation.order > 0 (a wall is excluded)", "make it adiabatic, or use order = 0"));
  if (state.implicit)
    throw InputError(
        advised("radiation.order > 0 (radiation.every_s is beyond 0.1 of the radiative time constant)",
                "shorten radiation.every_s, or use order = 0 or source = \"paths\""));
  const auto gives = [&](std::size_t s) { return s >= enclosure.sphere_count() && state.radiates(s); };
  std::vector<std::vector<double>> heats(replicates_.size());
  in_parallel(static_cast<int>(replicates_.size()), options_.threads, [&](int r) {
    heats[r] = heats[r] =
        solve_harmonic_radiosity(replicates_[r], state.emissive_power_W_m2, state.emissivity);
  });

  RadiativeHeat result;
  std::vector<double> given(heats.size(), 0);
  for (std::size_t s = 0; s < enclosure.surface_count(); ++s) {
    std::vector<double> of_surface;
    for (std::size_t r = 0; r < heats.size(); ++r) {
      of_surface.push_back(heats[r][s]);
      if (gives(s)) given[r] -= heats[r][s];
    }
    result.heat_W.push_back(mean(of_surface));
    result.standard_error_W.push_back(error_of_mean(of_surface));
  }
  result.isothermal_wall_heat_W = mean(given);
  result.isothermal_wall_heat_error_W = error_of_mean(given);
  return result;
}

}  // namespace granrad
