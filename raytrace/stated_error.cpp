#include "raytrace/stated_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"

namespace granrad {

namespace {

/// Rays per area of every surface.
std::vector<double> ray_densities(const HitCounts& counts) {
  std::vector<double> density;
  for (std::size_t i = 0; i < counts.launched.size(); ++i)
    density.push_back(counts.area_m2[i] > 0 ? static_cast<double>(counts.launched[i]) / counts.area_m2[i]
                                            : 0);
  return density;
}

/// Calls visit(i, j, k) for the count k of surface i on surface j.
template <class Visit>
void for_each_count(const HitCounts& counts, Visit&& visit) {
  for (std::size_t i = 0; i < counts.launched.size(); ++i)
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      visit(i, static_cast<std::size_t>(counts.pattern.column[static_cast<std::size_t>(k)]), k);
}

}  // namespace

StatedQuantity stated_quantity(const Enclosure& enclosure, const std::vector<std::int32_t>& hot_walls) {
  const std::size_t spheres = enclosure.sphere_count();
  StatedQuantity quantity{std::vector<char>(enclosure.surface_count(), 0), !hot_walls.empty()};
  if (hot_walls.empty())
    std::fill(quantity.counted.begin() + static_cast<std::ptrdiff_t>(spheres), quantity.counted.end(), 1);
  for (const std::int32_t wall : hot_walls) {
    if (wall < static_cast<std::int32_t>(spheres) ||
        wall >= static_cast<std::int32_t>(enclosure.open_surface()))
      throw InputError(fmt::format("hot walls: surface {} (must be a wall: {} to {})", wall, spheres,
                                   enclosure.open_surface() - 1));
    quantity.counted[static_cast<std::size_t>(wall)] = 1;
  }
  return quantity;
}

ParticleSums particle_sums(const HitCounts& counts, const StatedQuantity& quantity) {
  const auto spheres = static_cast<std::size_t>(counts.spheres);
  const std::vector<double> density = ray_densities(counts);
  const auto share = [&](std::size_t i, std::size_t j) { return density[i] / (density[i] + density[j]); };
  const std::vector<double> zero(spheres, 0);
  ParticleSums sums{zero, zero, zero};
  for_each_count(counts, [&](std::size_t i, std::size_t j, std::int64_t k) {
    const double f = static_cast<double>(counts.hits[static_cast<std::size_t>(k)]) /
                     static_cast<double>(counts.launched[i]);
    if (i < spheres && quantity.counted[j]) sums.value[i] += share(i, j) * f;
    if (j < spheres && quantity.counted[i])
      sums.value[j] += share(i, j) * f * counts.area_m2[i] / counts.area_m2[j];
  });
  std::vector<double> mean(spheres, 0);
  for_each_count(counts, [&](std::size_t i, std::size_t j, std::int64_t k) {
    const double n = static_cast<double>(counts.launched[i]);
    const double f = static_cast<double>(counts.hits[static_cast<std::size_t>(k)]) / n;
    const auto add = [&](std::size_t particle, bool counted, double variance) {
      sums.variance[particle] += variance;
      if (!counted) sums.of_row[particle] += variance;
    };
    if (i < spheres) {
      const double c = share(i, j) * (quantity.counted[j] - sums.value[i]);
      mean[i] += c * f;
      add(i, quantity.counted[j], counts.sum_variance_factor * c * c * f / n);
    }
    if (j < spheres) {
      const double c =
          share(i, j) * (quantity.counted[i] - sums.value[j]) * counts.area_m2[i] / counts.area_m2[j];
      add(j, quantity.counted[i], c * c * f * (1 - f) / n * count_variance_factor(counts, i, k));
    }
  });
  for (std::size_t i = 0; i < spheres; ++i)
    if (counts.launched[i] > 0)
      sums.variance[i] -=
          counts.sum_variance_factor * mean[i] * mean[i] / static_cast<double>(counts.launched[i]);
  return sums;
}

double ParticleSums::relative_error(bool relative_to_rms) const {
  const double sum = std::accumulate(value.begin(), value.end(), 0.0);
  const double squares = std::inner_product(value.begin(), value.end(), value.begin(), 0.0);
  const double scale =
      relative_to_rms ? std::sqrt(squares) : sum / std::sqrt(static_cast<double>(value.size()));
  return scale > 0 ? std::sqrt(std::accumulate(variance.begin(), variance.end(), 0.0)) / scale : 0;
}

}  // namespace granrad
