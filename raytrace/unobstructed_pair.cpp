#include "raytrace/unobstructed_pair.h"

#include <array>
#include <cstddef>

#include "raytrace/exact.h"

namespace granrad {

namespace {

constexpr int intervals = 4096, last = 2 * intervals;  // to contact; to overlaps of half a diameter

std::array<double, last + 2> tabulate() {
  std::array<double, last + 2> table{};
  table[0] = 1.0 / 16;  // far away
  for (int k = 1; k <= last; ++k) {
    const double d_star = static_cast<double>(intervals) / k;
    table[k] = exact_two_sphere(0.5, 0.5, d_star) * d_star * d_star;
  }
  table[last + 1] = table[last];
  return table;
}

}  // namespace

double unobstructed_pair(double d_star) {
  static const auto table = tabulate();
  if (d_star < 0.5) d_star = 0.5;
  const double at = intervals / d_star;
  const auto k = static_cast<std::size_t>(at);
  return (table[k] + (at - static_cast<double>(k)) * (table[k + 1] - table[k])) / (d_star * d_star);
}

}  // namespace granrad
