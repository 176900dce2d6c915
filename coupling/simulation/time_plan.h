#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"
#include "coupling/simulation/step_limits.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// Whole-number bookkeeping of a run: everything happens on ticks. One tick is one heat step:
/// `steps_per_tick` DEM steps in a moving bed, thousandths of itself in a frozen bed. Times are step *
/// step_s, so that no rounding adds up. The run ends on the step nearest to the end asked for: there its last
/// heat step is cut short.
struct TimePlan {
  std::int64_t origin_step = 0;  ///< where tick 0 stands: the start, or where a case went on with other steps
  double origin_s = 0;
  double step_s = 0;  ///< DEM step, or a thousandth of the heat step of a frozen bed
  std::int64_t steps_per_tick = 1;
  double tick_s = 0;
  std::int64_t ticks_per_radiation = 0;  ///< 0: no radiation
  std::int64_t ticks_per_row = 0, ticks_per_frame = 0;
  std::int64_t end_step = 0, end_tick = 0;

  std::int64_t step_at(std::int64_t tick) const {
    return std::min(origin_step + tick * steps_per_tick, end_step);
  }
  double time_of_step_s(std::int64_t step) const {
    return origin_s + static_cast<double>(step - origin_step) * step_s;
  }
  double time_s(std::int64_t tick) const { return time_of_step_s(step_at(tick)); }
  /// Length of the heat step that ends at `tick`.
  double heat_step_s(std::int64_t tick) const {
    return static_cast<double>(step_at(tick) - origin_step - (tick - 1) * steps_per_tick) * step_s;
  }
  bool cuts(std::int64_t tick) const { return origin_step + tick * steps_per_tick > end_step; }
  /// The tick that ends with this step; nothing where a heat step was cut there.
  std::optional<std::int64_t> tick_of(std::int64_t step) const;
  /// Radiation is renewed at the begin of an interval, rows and frames come at the end of theirs.
  bool radiation_at(std::int64_t tick) const {
    return ticks_per_radiation > 0 && (tick - 1) % ticks_per_radiation == 0;
  }
  bool row_at(std::int64_t tick) const { return tick % ticks_per_row == 0 || tick == end_tick; }
  bool frame_at(std::int64_t tick) const { return tick % ticks_per_frame == 0 || tick == end_tick; }

  /// A case goes on with the plan it was started with; only its end may move.
  StateBlock save() const;
  static TimePlan restored(const StateBlock& block, double end_time_s);

  /// Whether the scene still asks for the steps and intervals this plan was made for.
  bool serves(const Case& c) const;

  std::vector<double> asked{};  ///< by the scene: DEM step, steps per heat step and the intervals
};

/// Chooses steps within the limits so that radiation updates, rows and frames fall on ticks.
/// conduction_limit_s: largest stable heat step (infinite without conduction).
/// Throws InputError, every problem at once, each with the largest allowed value or the nearest ones that
/// fit. The plan begins where `bed` is.
TimePlan make_time_plan(const Case& c, const StepLimits& limits, double conduction_limit_s, const Bed& bed);

/// Tells that the end asked for lies between two steps and where the run ends instead; empty when it does
/// not.
std::string end_note(const TimePlan& plan, double end_time_s);

}  // namespace granrad
