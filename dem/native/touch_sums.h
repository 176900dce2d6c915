#pragma once
#include <cstdint>
#include <vector>

#include "dem/bed/touches.h"

namespace granrad::native {

/// Of two bodies, the sum over steps of the root of their contact area, in whole units (StepConstants::touch_units):
/// exact, so that neither lists nor threads matter. `first` is a row or a Bed index, `second` alike or a wall.
struct TouchSum {
  std::int32_t first, second;
  double units;
};

/// Adds up what belongs together, first ascending, and turns it into means; `rows` is how many firsts there are.
template <class Touch>
std::vector<Touch> touch_means(const std::vector<TouchSum>& sums, std::size_t rows, double units_per_m,
                               std::int64_t steps);

}  // namespace granrad::native
