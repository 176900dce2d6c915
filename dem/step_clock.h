#pragma once
#include <cmath>
#include <cstdint>

#include "dem/bed/bed.h"

namespace granrad {

/// Which instants the whole steps of a Bed are: its own time and step count fix step 0.
class StepClock {
 public:
  StepClock(const Bed& bed, double step_s) : step_s_(step_s) {
    const double origin_s = bed.time_s - double(bed.step) * step_s;
    start_s_ = std::abs(origin_s) < 1e-6 * step_s ? 0 : origin_s;  // rounding of the division is no offset
  }
  double time_s(std::int64_t step) const { return start_s_ + double(step) * step_s_; }
  /// The first step at or after `time_s`, up to rounding.
  std::int64_t first_at_or_after(double time_s) const {
    return static_cast<std::int64_t>(std::ceil((time_s - start_s_) / step_s_ - 1e-6));
  }

 private:
  double step_s_, start_s_;
};

}  // namespace granrad
