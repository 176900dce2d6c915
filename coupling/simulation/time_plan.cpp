#include "coupling/simulation/time_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr std::int64_t usual_steps_per_tick =
    100;  // contacts last hundreds of steps; conduction is slower still
constexpr std::int64_t parts_of_a_frozen_tick = 1000;  // a decimal end falls on one of them
constexpr double whole_number_tolerance = 1e-6;        // decimal input: 0.01 / 1e-5 is a whole number

struct Interval {
  const char* key;
  double seconds;
};

std::vector<Interval> intervals(const Case& c) {
  std::vector<Interval> all;
  if (c.heat.radiation.kind != RadiationKind::none)
    all.push_back({"radiation.every_s", c.heat.radiation.every_s});
  all.push_back({"output.every_s", c.heat.output.every_s});
  all.push_back({"output.frames_every_s", c.heat.output.frames_every_s});
  return all;
}

/// How many `unit` fit in `seconds`; 0 with a problem when not a whole number.
std::int64_t whole(const Interval& interval, double unit, const char* of_what,
                   std::vector<std::string>& problems) {
  const double ratio = interval.seconds / unit, rounded = std::round(ratio);
  if (rounded >= 1 && std::abs(ratio - rounded) <= whole_number_tolerance * std::max(1.0, ratio))
    return static_cast<std::int64_t>(rounded);
  const double below = std::max(1.0, std::floor(ratio));
  problems.push_back(fmt::format("{} = {:g} s (not a whole number of {} of {:.9g} s) try {:.9g} or {:.9g}",
                                 interval.key, interval.seconds, of_what, unit, below * unit,
                                 (below + 1) * unit));
  return 0;
}

std::int64_t largest_divisor(std::int64_t number, std::int64_t at_most) {
  for (std::int64_t d = std::min(number, std::max<std::int64_t>(at_most, 1)); d > 1; --d)
    if (number % d == 0) return d;
  return 1;
}

/// Splits `seconds` into equal steps no longer than `limit`, their number divisible by a number near
/// `usual_steps_per_tick`, so that heat steps can be long.
double dividing_step(double seconds, double limit) {
  const double count = std::ceil(seconds / limit * (1 - whole_number_tolerance));
  if (count <= usual_steps_per_tick) return seconds / count;
  const double blocks = std::ceil(count / usual_steps_per_tick);
  return seconds / (blocks * std::ceil(count / blocks));
}

double shortest(const std::vector<Interval>& all) {
  double least = all.front().seconds;
  for (const auto& interval : all) least = std::min(least, interval.seconds);
  return least;
}

void refuse_beyond(std::vector<std::string>& problems, const char* key, double value, double limit,
                   const char* why) {
  if (value > limit * (1 + whole_number_tolerance))
    problems.push_back(
        fmt::format("{} = {:g} s ({}) the largest allowed value is {:.4g} s", key, value, why, limit));
}

/// The DEM step, or the heat step of a frozen bed.
double choose_step(const Case& c, const StepLimits& limits, double conduction_limit_s,
                   std::vector<std::string>& problems) {
  const double base = shortest(intervals(c));
  if (c.flow.engine == EngineKind::none) return base / std::ceil(base / std::min(base, conduction_limit_s));
  if (!(c.flow.step_s > 0)) return dividing_step(base, std::min(limits.dem_s, base));
  refuse_beyond(problems, "dem.step_s", c.flow.step_s, limits.dem_s,
                fmt::format("0.3 Rayleigh times = {:.3g} s, 0.1 Hertz times = {:.3g} s at {:.3g} m/s",
                            0.3 * limits.rayleigh_time_s, 0.1 * limits.hertz_time_s, limits.impact_speed_m_s)
                    .c_str());
  return c.flow.step_s;
}

std::int64_t choose_steps_per_tick(const Case& c, std::int64_t divisor, double step_s,
                                   double conduction_limit_s, std::vector<std::string>& problems) {
  if (c.flow.engine == EngineKind::none) return 1;
  const std::int64_t wanted = c.heat.conduction_every_steps;
  if (wanted == 0) {
    const double most = std::min<double>(usual_steps_per_tick, std::floor(conduction_limit_s / step_s));
    return largest_divisor(divisor, static_cast<std::int64_t>(most));
  }
  if (divisor % wanted != 0)
    problems.push_back(
        fmt::format("conduction.every_steps = {} (radiation, rows and frames come every multiple of {} "
                    "steps, which it does not divide) try {}",
                    wanted, divisor, largest_divisor(divisor, wanted)));
  refuse_beyond(problems, "conduction.every_steps * dem.step_s", static_cast<double>(wanted) * step_s,
                conduction_limit_s, "0.1 of the shortest conduction time constant");
  return wanted;
}

void end_at(TimePlan& plan, double end_time_s) {
  plan.end_step = std::max<std::int64_t>(1, std::llround(end_time_s / plan.step_s));
  plan.end_tick = (plan.end_step + plan.steps_per_tick - 1) / plan.steps_per_tick;
}

}  // namespace

TimePlan make_time_plan(const Case& c, const StepLimits& limits, double conduction_limit_s) {
  std::vector<std::string> problems;
  if (c.heat.radiation.kind != RadiationKind::none)
    refuse_beyond(problems, "radiation.every_s", c.heat.radiation.every_s, limits.radiation_s,
                  "0.1 of the radiative time constant of the smallest particle at the hottest temperature");
  TimePlan plan;
  plan.step_s = choose_step(c, limits, conduction_limit_s, problems);
  std::int64_t divisor = 0;
  std::vector<std::int64_t> steps;
  for (const auto& interval : intervals(c)) {
    steps.push_back(whole(interval, plan.step_s,
                          c.flow.engine == EngineKind::none ? "heat steps" : "DEM steps", problems));
    divisor = std::gcd(divisor, steps.back());
  }
  plan.steps_per_tick = choose_steps_per_tick(c, divisor, plan.step_s, conduction_limit_s, problems);
  if (!problems.empty()) throw InputError(problems);

  plan.ticks_per_frame = steps.back() / plan.steps_per_tick;
  plan.ticks_per_row = steps[steps.size() - 2] / plan.steps_per_tick;
  if (steps.size() == 3) plan.ticks_per_radiation = steps.front() / plan.steps_per_tick;
  if (c.flow.engine == EngineKind::none) {
    plan.steps_per_tick = parts_of_a_frozen_tick;
    plan.step_s /= static_cast<double>(parts_of_a_frozen_tick);
  }
  plan.tick_s = static_cast<double>(plan.steps_per_tick) * plan.step_s;
  end_at(plan, c.flow.end_time_s);
  return plan;
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
  block.reals["step_s"] = {step_s};
  block.integers["steps_per_tick"] = {steps_per_tick};
  block.integers["ticks_per"] = {ticks_per_radiation, ticks_per_row, ticks_per_frame};
  return block;
}

TimePlan TimePlan::restored(const StateBlock& block, double end_time_s) {
  TimePlan plan;
  plan.step_s = block.reals.at("step_s").at(0);
  plan.steps_per_tick = block.integers.at("steps_per_tick").at(0);
  plan.tick_s = static_cast<double>(plan.steps_per_tick) * plan.step_s;
  const auto& ticks_per = block.integers.at("ticks_per");
  plan.ticks_per_radiation = ticks_per.at(0);
  plan.ticks_per_row = ticks_per.at(1);
  plan.ticks_per_frame = ticks_per.at(2);
  end_at(plan, end_time_s);
  return plan;
}

}  // namespace granrad
