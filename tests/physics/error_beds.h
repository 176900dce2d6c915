#pragma once
#include "raytrace/rays/view_factors.h"
#include "tests/line_cases.h"

namespace granrad::error_beds {

inline constexpr double r = 4e-4;

inline const Enclosure& equal_bed() {
  static const Box box{{0, 0, 0}, {0.004, 0.004, 0.004}};
  static const Enclosure bed = packed(box, equal_radii(box, 0.45, r));
  return bed;
}

/// Radii from 1 to 4.
inline const Enclosure& mixed_bed() {
  static const Enclosure bed = [] {
    std::vector<double> radii;
    for (int k = 0; k < 80; ++k) radii.push_back(r * (k % 16 == 0 ? 2.4 : k % 3 == 0 ? 1 : 0.6));
    return packed({{0, 0, 0}, {0.0055, 0.0055, 0.0055}}, radii);
  }();
  return bed;
}

inline ExchangeAreas closed(const HitCounts& counts) {
  ClosureReport report;
  return close(one_way_estimate(counts), Closure::reciprocal, report);
}

}  // namespace granrad::error_beds
