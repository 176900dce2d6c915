#pragma once
#include <cmath>
#include <vector>

#include "dem/packing/packing.h"
#include "raytrace/lines/line_sweep.h"
#include "tests/enclosures.h"

namespace granrad {

/// A random packing of `radii` in a closed box.
inline Enclosure packed(const Box& box, const std::vector<double>& radii, int sweeps = 20) {
  PackingRequest request;
  request.where.box = box;
  request.radius_m = radii;
  request.equilibration_sweeps = sweeps;
  return boxed(spheres_in_open_space(pack_spheres(request), radii), box);
}

inline double variance(const ExchangeAreas& x, std::size_t i, std::size_t j) {
  for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
    if (x.pattern.column[static_cast<std::size_t>(k)] == static_cast<std::int32_t>(j))
      return x.variance[static_cast<std::size_t>(k)];
  return 0;
}

/// A quantity from several independent runs: mean, and the standard error of it.
struct Repeated {
  double mean = 0, error = 0;
  double sigmas_off(double exact) const { return (mean - exact) / error; }
};

/// Runs estimate(seed) for seeds 1 .. runs.
template <class Estimate>
Repeated repeat(int runs, Estimate&& estimate) {
  double sum = 0, square = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const double value = estimate(static_cast<std::uint64_t>(seed));
    sum += value, square += value * value;
  }
  const double mean = sum / runs;
  return {mean, std::sqrt(std::max(0.0, square / runs - mean * mean) / (runs - 1))};
}

}  // namespace granrad
