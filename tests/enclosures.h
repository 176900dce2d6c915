#pragma once
#include <cmath>
#include <vector>

#include "raytrace/exchange.h"

namespace granrad {

/// Enclosures made by hand for tests.
inline Enclosure spheres_in_open_space(const std::vector<Vec3>& centre_m,
                                       const std::vector<double>& radius_m) {
  Enclosure e;
  e.centre_m = centre_m;
  e.radius_m = radius_m;
  for (std::size_t i = 0; i < centre_m.size(); ++i) e.particle.push_back(static_cast<std::int32_t>(i));
  return e;
}

inline Enclosure boxed(Enclosure e, const Box& box) {
  for (const Wall& wall : box_walls(box)) {
    e.walls.push_back(wall);
    e.wall.push_back(static_cast<std::int32_t>(e.wall.size()));
  }
  e.box = box;
  return e;
}

/// The channel of the paper, 10 x 4 x 50 mm.
inline Box channel() {
  return {{0, 0, 0}, {0.010, 0.004, 0.050}};
}

/// hits of (i, j); 0 where the pair is not in the pattern.
inline double hits(const HitCounts& counts, std::size_t i, std::size_t j) {
  for (auto k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
    if (counts.pattern.column[static_cast<std::size_t>(k)] == static_cast<std::int32_t>(j))
      return static_cast<double>(counts.hits[static_cast<std::size_t>(k)]);
  return 0;
}

inline double factor(const HitCounts& counts, std::size_t i, std::size_t j) {
  return hits(counts, i, j) / static_cast<double>(counts.launched[i]);
}

/// Deviation of a counted view factor from the exact one, in binomial standard errors.
inline double sigmas_off(const HitCounts& counts, std::size_t i, std::size_t j, double exact) {
  const double n = static_cast<double>(counts.launched[i]);
  return (factor(counts, i, j) - exact) / std::sqrt(exact * (1 - exact) / n);
}

inline double value(const ExchangeAreas& x, std::size_t i, std::size_t j) {
  for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
    if (x.pattern.column[static_cast<std::size_t>(k)] == static_cast<std::int32_t>(j))
      return x.value[static_cast<std::size_t>(k)];
  return 0;
}

inline double row_sum(const ExchangeAreas& x, std::size_t i) {
  double sum = 0;
  for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
    sum += x.value[static_cast<std::size_t>(k)];
  return sum;
}

}  // namespace granrad
