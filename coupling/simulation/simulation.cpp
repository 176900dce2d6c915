#include "coupling/simulation/simulation.h"

#include <fmt/core.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "coupling/heat/heat_step.h"
#include "coupling/simulation/radiation_check.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/io/saved_state.h"
#include "dem/ranks/ranks.h"
#include "raytrace/rays/enclosure_check.h"

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

/// The short loops beside the flow get as many threads as the flow found worth while.
class ThreadsOfFlow {
 public:
  explicit ThreadsOfFlow(const Flow& flow) : before_(omp_get_max_threads()) {
    if (flow.moves()) omp_set_num_threads(std::min(flow.threads().used, before_));
  }
  ~ThreadsOfFlow() { omp_set_num_threads(before_); }
  ThreadsOfFlow(const ThreadsOfFlow&) = delete;

 private:
  int before_;
};

/// Ranks that trace a part of the rays each must see the same bed.
void require_same_bed_on_ranks(const Bed& bed) {
  if (rank_count() == 1) return;
  std::string bytes(reinterpret_cast<const char*>(bed.position_m.data()), bed.size() * sizeof(Vec3));
  bytes.append(reinterpret_cast<const char*>(bed.temperature_K.data()), bed.size() * sizeof(double));
  require_same_on_ranks(text_hash(bytes), fmt::format("the bed at {:g} s", bed.time_s));
}

/// Particles that take no part in the heat; a plug has some above and below its region by design.
std::string outside_note(const Scene& scene, const Bed& bed) {
  const auto inside = in_region(bed, scene.region);
  const auto outside = std::count(inside.begin(), inside.end(), 0);
  if (outside == 0 || scene.feed.kind == FeedSettings::Kind::plug) return "";
  return advised(fmt::format("{} of {} particles lie outside the heat-transfer region: they neither conduct "
                             "nor radiate",
                             outside, bed.size()),
                 "widen [region], or [box]");
}

/// Engines that keep no record of what touched between heat steps: contacts conduct as they stand at each.
std::string sampled_contacts_note(const Case& c, const StepLimits& limits, const TimePlan& plan) {
  constexpr double samples_of_a_collision = 10;
  if (!c.heat.conduction.solid || c.heat.conduction.rough) return "";
  if (c.flow.engine == EngineKind::replay)
    return fmt::format(
        "a recorded flow tells its contacts at heat steps alone, {:.3g} s apart: those that last are "
        "heated through, collisions shorter than that are missed or count too long",
        plan.tick_s);
  if (c.flow.engine != EngineKind::liggghts || plan.tick_s * samples_of_a_collision <= limits.hertz_time_s)
    return "";
  const double steps =
      std::max(1.0, std::floor(limits.hertz_time_s / (samples_of_a_collision * plan.step_s)));
  return fmt::format(
      "LIGGGHTS tells its contacts at heat steps alone, {:.3g} s apart, and a collision lasts {:.3g} s: "
      "conduction.every_steps = {:.0f} follows it, dem.engine = \"native\" integrates it",
      plan.tick_s, limits.hertz_time_s, steps);
}

/// Gas lenses are looked at where spheres stand at each heat step.
std::string sampled_lenses_note(const Case& c, const StepLimits& limits, const TimePlan& plan,
                                const Bed& bed) {
  if (!c.heat.conduction.gas || !computes_forces(c.flow.engine) || !(limits.motion_s < infinity)) return "";
  const double radius = bed.size() ? *std::max_element(bed.radius_m.begin(), bed.radius_m.end())
                                   : c.flow.particle_diameter_m / 2;
  const double reach_m = lens_cutoff_gap_m(c.heat.conduction, radius);
  const double moved_m = 2 * radius / limits.motion_s * plan.tick_s;
  constexpr double coarse = 0.5, fine = 0.1;
  if (!(moved_m > coarse * reach_m)) return "";
  const double steps =
      std::max(1.0, std::floor(static_cast<double>(plan.steps_per_tick) * fine * reach_m / moved_m));
  return advised(
      fmt::format(
          "gas lenses reach {:.2g} m and are followed at heat steps alone, in each of which the fastest "
          "particle moves {:.2g} m: right in the mean of many encounters, coarse for one",
          reach_m, moved_m),
      fmt::format("conduction.every_steps = {:.0f} follows each", steps));
}

}  // namespace

Simulation::Simulation(const Case& c, int threads)
    : case_(c), flow_(c.flow, threads), heat_(c, threads), recorder_(c) {
  identity_ = static_cast<std::int64_t>(text_hash(c.identity));
  flow_.record_touches(c.heat.conduction.solid && !c.heat.conduction.rough);
}

void Simulation::start(Bed bed) {
  bed_ = std::move(bed);
  make_plan();
  notes_ = case_.flow.notes;
  if (const auto note = outside_note(case_.flow, bed_); !note.empty()) notes_.push_back(note);
  if (auto note = sampled_contacts_note(case_, limits_, plan_); !note.empty())
    notes_.push_back(std::move(note));
  if (auto note = sampled_lenses_note(case_, limits_, plan_, bed_); !note.empty())
    notes_.push_back(std::move(note));
  if (case_.heat.radiation.kind != RadiationKind::none)
    for (auto& note : turn_meshes_to_particles(bed_, case_.flow.region)) notes_.push_back(std::move(note));
  for (auto& note : check_radiation(case_.heat.radiation, case_.flow, bed_, case_.heat.surroundings_K))
    notes_.push_back(std::move(note));
  heat_.start(bed_);
  recorder_.start(bed_);
}

void Simulation::make_plan() {
  limits_ = step_limits(case_, bed_);
  conduction_limit_s_ = conduction_step_limit_s(bed_, heat_.conduct(bed_, flow_));
  plan_ = make_time_plan(case_, limits_, conduction_limit_s_, bed_);
  tick_ = 0;
}

bool Simulation::resume(const Snapshot& frame) {
  if (saved_integer(saved_block(frame, "case"), "identity") != identity_)
    throw InputError(advised(fmt::format("{} (a frame of another scene)", frame.origin),
                             "[particles] file = this frame starts a new case from it"));
  const auto plan = TimePlan::restored(saved_block(frame, "plan"), case_.flow.end_time_s);
  const auto tick = plan.tick_of(frame.bed.step);
  if (!tick) return false;
  bed_ = frame.bed;
  flow_.load(saved_block(frame, "feed"));
  heat_.load(saved_block(frame, "radiation"), saved_block(frame, "ledger"));
  heat_.load_walls(saved_block(frame, "walls"));
  recorder_.load(saved_block(frame, "recorder"));
  plan_ = plan;
  tick_ = *tick;
  if (!plan.serves(case_)) make_plan();
  return true;
}

void Simulation::advance() {
  ++tick_;
  const double from_s = plan_.time_s(tick_ - 1), to_s = plan_.time_s(tick_);
  const auto hold_walls = [&](double until_s) {
    hold_temperatures(bed_.walls, case_.flow.walls, from_s, until_s);
  };
  {
    Stopwatch watch(seconds_.flow);
    flow_.advance(bed_, plan_, tick_);
  }
  {
    Stopwatch watch(seconds_.conduction);
    const ThreadsOfFlow threads(flow_);
    heat_.conduct(bed_, flow_);
  }
  if (plan_.radiation_at(tick_)) {
    Stopwatch watch(seconds_.radiation);
    require_same_bed_on_ranks(bed_);
    const double interval_s = static_cast<double>(plan_.ticks_per_radiation) * plan_.tick_s;
    hold_walls(from_s + interval_s);
    heat_.radiate(bed_, interval_s);
  }
  Stopwatch watch(seconds_.conduction);
  const ThreadsOfFlow threads(flow_);
  hold_walls(to_s);
  heat_.advance(bed_, plan_.heat_step_s(tick_));
  hold_temperatures(bed_.walls, case_.flow.walls, to_s, to_s);
}

void Simulation::keep(Snapshot& into) const {
  into.bed = bed_;
  into.state["case"].integers["identity"] = {identity_};
  into.state["plan"] = plan_.save();
  into.state["feed"] = flow_.save();
  into.state["radiation"] = heat_.save();
  into.state["ledger"] = heat_.save_ledger();
  into.state["walls"] = heat_.save_walls();
  into.state["recorder"] = recorder_.save();
}

void Simulation::write_checkpoint(const std::filesystem::path& file) const {
  Snapshot now;
  keep(now);
  write_frame(file, now.bed, now.state);
}

}  // namespace granrad
