#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad::trace_bench {

inline constexpr double radius = 4e-4;

/// Peak memory since the last reset, MiB (Linux: VmHWM).
double peak_MiB(bool reset = false);

struct Case {
  std::size_t count;
  double solid_fraction;
  Enclosure bed;
  std::vector<std::pair<std::size_t, std::size_t>> near;  ///< closer than 1.1 diameters
  std::string name() const;
};

/// At most this solid fraction: what fits.
Case make_case(std::size_t count, double fraction);

/// What a user wants from a trace: by particle, and for pairs in contact or nearly so.
struct Result {
  std::vector<double> near, wall_sum,
      flux;  ///< F of near pairs; F to all walls; F to the hot walls y_min and y_max
  double rays = 0, seconds = 0, build_s = 0, memory_MiB = 0;
  double trace_s = 0;  ///< of `seconds`, spent in finding hits (bare Embree)
};

struct Errors {
  double near = 0, wall_sum = 0, flux = 0, heat = 0;
};

/// Errors of one of two independent results, relative.
Errors compare(const Result& a, const Result& b);

}  // namespace granrad::trace_bench
