#pragma once
#include <cstdint>

#include "raytrace/line_pass.h"

namespace granrad {

/// Void met along the lines of some directions: total length, and the number of gaps between neighbours.
struct ChordSums {
  double length_m = 0;
  std::int64_t gaps = 0;
  ChordSums& operator+=(const ChordSums& b) { return length_m += b.length_m, gaps += b.gaps, *this; }
  /// Mean free length of a ray over all surfaces, m (each gap is seen from both of its ends); 0 without gaps.
  double mean() const { return gaps > 0 ? length_m / static_cast<double>(gaps) : 0; }
};

/// For the direction `pass` was aimed at, gap by gap from the positions of both ends, in double precision.
/// Lines that escape are left out. Slow beside the kernels: for a self-check on a few directions.
ChordSums chord_sums(LinePass& pass);

}  // namespace granrad
