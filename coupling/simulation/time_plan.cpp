#include "coupling/simulation/time_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/io/saved_state.h"

BOOST_HANA_ADAPT_STRUCT(granrad::TimePlan, origin_step, steps_per_tick, ticks_per_radiation, ticks_per_row,
                        ticks_per_frame, origin_s, step_s);

namespace granrad {

namespace {

constexpr std::int64_t usual_steps_per_tick =
    100;  // contacts last hundreds of steps; conduction is slower still
constexpr std::int64_t parts_of_a_frozen_tick = 1000;  // a decimal end falls on one of them
constexpr double most_steps = 1e13, most_rows = 1e8, most_frames = 1e6, most_updates = 1e9;
constexpr double whole_number_tolerance = 1e-6;  // decimal input: 0.01 / 1e-5 is a whole number

struct Interval {
  const char* key;
  double seconds;
};

std::int64_t largest_divisor(std::int64_t number, std::int64_t at_most) {
  for (std::int64_t d = std::min(number, std::max<std::int64_t>(at_most, 1)); d > 1; --d)
    if (number % d == 0) return d;
  return 1;
}

/// An interval that was chosen and not given becomes a whole number of the DEM steps that were given.
double fitted_radiation_interval_s(const Case& c, const StepLimits& limits) {
  const double seconds = radiation_interval_s(c, limits), step = c.flow.step_s;
  if (c.heat.radiation.every_s > 0 || !computes_forces(c.flow.engine) || !(step > 0)) return seconds;
  const auto row = std::llround(c.heat.output.every_s / step);
  return step *
         static_cast<double>(largest_divisor(row, static_cast<std::int64_t>(seconds / step * (1 + 1e-9))));
}

/// Everything that comes at intervals.
struct Intervals {
  std::optional<Interval> radiation;
  Interval row, frame;

  Intervals(const Case& c, const StepLimits& limits)
      : row{"output.every_s", c.heat.output.every_s},
        frame{"output.frames_every_s", c.heat.output.frames_every_s} {
    if (c.heat.radiation.kind != RadiationKind::none)
      radiation = {"radiation.every_s", fitted_radiation_interval_s(c, limits)};
  }
  double shortest_s() const {
    return std::min({radiation ? radiation->seconds : infinity, row.seconds, frame.seconds});
  }
};

/// What the scene asks of a plan: a case whose scene asks for something else goes on with another one.
std::vector<double> asked_of_plan(const Case& c) {
  const bool radiates = c.heat.radiation.kind != RadiationKind::none;
  return {c.flow.step_s, static_cast<double>(c.heat.conduction_every_steps),
          radiates ? c.heat.radiation.every_s : 0, c.heat.output.every_s, c.heat.output.frames_every_s};
}

/// How many `unit` fit in `seconds`; 0 with a problem when not a whole number.
std::int64_t whole(const Interval& interval, double unit, const char* of_what,
                   std::vector<std::string>& problems) {
  const double ratio = interval.seconds / unit, rounded = std::round(ratio);
  if (rounded >= 1 && std::abs(ratio - rounded) <= whole_number_tolerance * std::max(1.0, ratio))
    return static_cast<std::int64_t>(rounded);
  const double below = std::max(1.0, std::floor(ratio));
  problems.push_back(advised(fmt::format("{} = {:g} s (not a whole number of {} of {:.9g} s)", interval.key,
                                         interval.seconds, of_what, unit),
                             fmt::format("try {:.9g} or {:.9g}", below * unit, (below + 1) * unit)));
  return 0;
}

/// Splits `seconds` into equal steps no longer than `limit`, their number divisible by a number near
/// `usual_steps_per_tick`, so that heat steps can be long.
double dividing_step(double seconds, double limit) {
  const double count = std::ceil(seconds / limit * (1 - whole_number_tolerance));
  if (count <= usual_steps_per_tick) return seconds / count;
  const double blocks = std::ceil(count / usual_steps_per_tick);
  return seconds / (blocks * std::ceil(count / blocks));
}

void refuse_beyond(std::vector<std::string>& problems, const char* key, double value, double limit,
                   const char* why) {
  if (value > limit * (1 + whole_number_tolerance))
    problems.push_back(advised(fmt::format("{} = {:g} s ({})", key, value, why),
                               fmt::format("the largest allowed value is {:.4g} s", limit)));
}

/// A run no machine ends, or no disk holds.
void refuse_endless(std::vector<std::string>& problems, const char* what, double count, double most,
                    const char* advice) {
  if (!(count <= most))
    problems.push_back(
        advised(fmt::format("the run would take {:.3g} {} (at most {:g})", count, what, most), advice));
}

/// Heat steps of a frozen bed are free to be long, but walls open between them: within 1 % of the time before.
double shutter_step_s(const Case& c, double base_s) {
  double first_s = infinity;
  for (const Wall& wall : c.flow.walls)
    if (wall.opens_at_s > 0) first_s = std::min(first_s, wall.opens_at_s);
  return std::max(first_s / 100, base_s / 1000);
}

/// The DEM step, or the heat step of a frozen bed.
double choose_step(const Case& c, const StepLimits& limits, double conduction_limit_s,
                   std::vector<std::string>& problems) {
  const double base = Intervals(c, limits).shortest_s();
  if (!computes_forces(c.flow.engine)) {
    // contacts of a recording are not known ahead: room for four times those of its first snapshot
    const double room = c.flow.engine == EngineKind::replay ? 0.25 : 1;
    return base / std::ceil(base / std::min({base, room * conduction_limit_s, shutter_step_s(c, base)}));
  }
  if (!(c.flow.step_s > 0)) return dividing_step(base, std::min(limits.dem_s, base));
  refuse_beyond(problems, "dem.step_s", c.flow.step_s, limits.dem_s,
                fmt::format("0.3 Rayleigh times = {:.3g} s, 0.1 Hertz times = {:.3g} s at {:.3g} m/s",
                            0.3 * limits.rayleigh_time_s, 0.1 * limits.hertz_time_s, limits.impact_speed_m_s)
                    .c_str());
  return c.flow.step_s;
}

std::int64_t choose_steps_per_tick(const Case& c, std::int64_t divisor, double step_s,
                                   double conduction_limit_s, std::vector<std::string>& problems) {
  if (!computes_forces(c.flow.engine)) return 1;
  const std::int64_t wanted = c.heat.conduction_every_steps;
  if (wanted == 0) {
    const double most = std::min<double>(usual_steps_per_tick, std::floor(conduction_limit_s / step_s));
    return largest_divisor(divisor, static_cast<std::int64_t>(most));
  }
  if (divisor % wanted != 0)
    problems.push_back(advised(
        fmt::format("conduction.every_steps = {} (radiation, rows and frames come every multiple of {} "
                    "steps, which it does not divide)",
                    wanted, divisor),
        fmt::format("try {}", largest_divisor(divisor, wanted))));
  return wanted;
}

void end_at(TimePlan& plan, double end_time_s) {
  const auto steps = std::max<std::int64_t>(1, std::llround((end_time_s - plan.origin_s) / plan.step_s));
  plan.end_step = plan.origin_step + steps;
  plan.end_tick = (steps + plan.steps_per_tick - 1) / plan.steps_per_tick;
}

}  // namespace

TimePlan make_time_plan(const Case& c, const StepLimits& limits, double conduction_limit_s, const Bed& bed) {
  std::vector<std::string> problems;
  const bool frozen = !computes_forces(c.flow.engine);  // steps are those of the heat alone
  TimePlan plan;
  plan.asked = asked_of_plan(c);
  plan.step_s = choose_step(c, limits, conduction_limit_s, problems);
  const Intervals every(c, limits);
  const auto steps_of = [&](const Interval& interval) {
    return whole(interval, plan.step_s, frozen ? "heat steps" : "DEM steps", problems);
  };
  const std::int64_t radiation = every.radiation ? steps_of(*every.radiation) : 0;
  const std::int64_t row = steps_of(every.row), frame = steps_of(every.frame);
  const std::int64_t divisor = std::gcd(radiation, std::gcd(row, frame));
  refuse_endless(problems, "steps", c.flow.end_time_s / plan.step_s, most_steps, "shorten scene.end_time_s");
  refuse_endless(problems, "rows of history.csv", c.flow.end_time_s / every.row.seconds, most_rows,
                 "raise output.every_s");
  refuse_endless(problems, "frames", c.flow.end_time_s / every.frame.seconds, most_frames,
                 "raise output.frames_every_s");
  if (every.radiation)
    refuse_endless(problems, "updates of the radiation", c.flow.end_time_s / every.radiation->seconds,
                   most_updates, "raise radiation.every_s");
  plan.steps_per_tick = choose_steps_per_tick(c, divisor, plan.step_s, conduction_limit_s, problems);
  if (!problems.empty()) throw InputError(problems);

  plan.ticks_per_radiation = radiation / plan.steps_per_tick;
  plan.ticks_per_row = row / plan.steps_per_tick;
  plan.ticks_per_frame = frame / plan.steps_per_tick;
  if (frozen) {
    plan.steps_per_tick = parts_of_a_frozen_tick;
    plan.step_s /= static_cast<double>(parts_of_a_frozen_tick);
  }
  plan.tick_s = static_cast<double>(plan.steps_per_tick) * plan.step_s;
  plan.origin_step = bed.step;
  plan.origin_s = bed.time_s;
  end_at(plan, c.flow.end_time_s);
  return plan;
}

bool TimePlan::serves(const Case& c) const {
  return asked == asked_of_plan(c);
}

std::optional<std::int64_t> TimePlan::tick_of(std::int64_t step) const {
  const std::int64_t steps = step - origin_step;
  if (steps % steps_per_tick == 0) return steps / steps_per_tick;
  return step >= end_step ? std::optional(end_tick) : std::nullopt;
}

std::string end_note(const TimePlan& plan, double end_time_s) {
  const double ends_s = plan.time_s(plan.end_tick);
  constexpr double rounding = 1e-3;  // of a step: decimal times are not whole numbers of decimal steps
  if (std::abs(ends_s - end_time_s) <= rounding * plan.step_s) return "";
  return fmt::format(
      "scene.end_time_s = {:.12g} s (not a whole number of steps of {:.9g} s): the run ends at {:.12g} s",
      end_time_s, plan.step_s, ends_s);
}

StateBlock TimePlan::save() const {
  StateBlock block;
  save_values(*this, block);
  block.reals["asked"] = asked;
  return block;
}

TimePlan TimePlan::restored(const StateBlock& block, double end_time_s) {
  TimePlan plan;
  restore_values(plan, block);
  plan.asked = saved_reals(block, "asked");
  if (!(plan.step_s > 0) || plan.steps_per_tick < 1 || plan.ticks_per_row < 1 || plan.ticks_per_frame < 1 ||
      plan.ticks_per_radiation < 0)
    throw InputError("the plan of the run is damaged");
  plan.tick_s = static_cast<double>(plan.steps_per_tick) * plan.step_s;
  end_at(plan, end_time_s);
  return plan;
}

}  // namespace granrad
