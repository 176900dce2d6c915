#include "raytrace/paths/path_tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"

namespace granrad {

void PathTally::add(const PathTally& other) {
  for (std::size_t s = 0; s < heat.size(); ++s) heat[s] += other.heat[s];
  for (std::size_t s = 0; s < clear_heat.size(); ++s) clear_heat[s] += other.clear_heat[s];
  moments.add(other.moments);
  segments += other.segments;
  lost += other.lost;
}

void PathTally::clear() {
  std::fill(heat.begin(), heat.end(), 0);
  std::fill(clear_heat.begin(), clear_heat.end(), 0);
  moments = {};
  segments = lost = 0;
}

double heat_quantum_W(double bound_W, double finest_W) {
  constexpr int usual_bits = 50, most_bits = 110, bits_of_a_walk = 12, wanted_bits_of_a_walk = 24;
  if (!(bound_W > 0)) return 1;
  const double top = std::ceil(std::log2(bound_W));
  if (!(finest_W > 0) || finest_W >= std::exp2(top - usual_bits + bits_of_a_walk))
    return std::exp2(top - usual_bits);
  const double exponent = std::floor(std::log2(finest_W)) - wanted_bits_of_a_walk;
  if (top - exponent > most_bits)
    throw NumericalError(advised(
        fmt::format(
            "paths: heats from {:.2g} W of one walk to {:.2g} W in all (beyond the range of the sums)",
            finest_W, bound_W),
        "leave out particles or walls that are too small or too large to matter"));
  return std::exp2(exponent);
}

}  // namespace granrad
