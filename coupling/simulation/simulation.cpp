#include "coupling/simulation/simulation.h"

#include <fmt/core.h>

#include <chrono>
#include <limits>

#include "coupling/heat/heat_step.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

/// Adds the time until its end to a counter.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), begin_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

Simulation::Simulation(const Case& c, int threads)
    : case_(c), flow_(c.flow, threads), heat_(c, threads), recorder_(c) {}

void Simulation::start(Bed bed) {
  bed_ = std::move(bed);
  limits_ = step_limits(case_, bed_);
  conduction_limit_s_ = conduction_step_limit_s(bed_, heat_.conduct(bed_, flow_));
  plan_ = make_time_plan(case_, limits_, conduction_limit_s_);
  check_radiation(case_.heat.radiation, case_.flow, bed_);
  tick_ = 0;
  heat_.start(bed_);
  recorder_.start(bed_);
}

bool Simulation::resume(const Snapshot& frame) {
  try {
    const auto plan = TimePlan::restored(frame.state.at("plan"), case_.flow.end_time_s);
    if (frame.bed.step % plan.steps_per_tick != 0 && frame.bed.step < plan.end_step) return false;
    bed_ = frame.bed;
    plan_ = plan;
    flow_.load(frame.state.at("feed"));
    heat_.load(frame.state.at("radiation"), frame.state.at("ledger"));
    recorder_.load(frame.state.at("recorder"));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format(
        "{} (a frame without the state of a run: it cannot be resumed) start a new case", frame.origin));
  }
  tick_ = bed_.step / plan_.steps_per_tick;
  return true;
}

void Simulation::advance() {
  ++tick_;
  {
    Stopwatch watch(seconds_.flow);
    flow_.advance(bed_, plan_, tick_);
  }
  {
    Stopwatch watch(seconds_.conduction);
    heat_.conduct(bed_, flow_);
  }
  if (plan_.radiation_at(tick_)) {
    Stopwatch watch(seconds_.radiation);
    heat_.radiate(bed_);
  }
  Stopwatch watch(seconds_.conduction);
  heat_.advance(bed_, plan_.heat_step_s(tick_));
}

void Simulation::write_checkpoint(const std::filesystem::path& file) const {
  StateBlocks state;
  state["plan"] = plan_.save();
  state["feed"] = flow_.save();
  state["radiation"] = heat_.save();
  state["ledger"] = heat_.save_ledger();
  state["recorder"] = recorder_.save();
  write_frame(file, bed_, state);
}

}  // namespace granrad
