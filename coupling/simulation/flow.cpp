#include "coupling/simulation/flow.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/engine_liggghts.h"
#include "dem/engine_native.h"
#include "dem/engine_replay.h"
#include "dem/io/saved_state.h"

namespace granrad {

namespace {

std::unique_ptr<Engine> make_engine(const Scene& scene, const Bed& bed, double step_s, int threads) {
  if (scene.engine == EngineKind::replay) return make_replay_engine(scene);
  if (scene.engine == EngineKind::liggghts) return make_liggghts_engine(scene.gravity_m_s2, step_s);
  return make_native_engine(bed, scene.gravity_m_s2, step_s, threads, scene.precision);
}

}  // namespace

Flow::Flow(const Scene& scene, int threads) : scene_(scene), threads_(threads) {
  if (scene.feed.kind != FeedSettings::Kind::none) feed_ = std::make_unique<Feed>(scene);
  if (!feed_ && !scene.removals.empty()) feed_ = std::make_unique<Feed>(scene);
}

Bed Flow::first_bed() {
  if (scene_.engine == EngineKind::replay) {
    const double length_s = recorded_s(scene_);
    constexpr double rounding = 1e-9;
    if (scene_.end_time_s > length_s * (1 + rounding))
      throw InputError(
          advised(fmt::format("scene.end_time_s = {:g} s (the recording of {} files is {:g} s long)",
                              scene_.end_time_s, scene_.replay.files.size(), length_s),
                  "end earlier, or give dem.step_s, the step of the recorded flow"));
  }
  Bed bed = initial_bed(scene_);
  bed.time_s = 0;
  bed.step = 0;
  if (feed_) feed_->start(bed);
  return bed;
}

StateBlock Flow::save() const {
  if (feed_) return feed_->save();
  StateBlock state;
  if (scene_.engine == EngineKind::replay) {
    state.reals["recorded"] = {recorded_.mass_in_kg, recorded_.mass_out_kg, recorded_.heat_in_J,
                               recorded_.heat_out_J};
    state.integers["inserted"] = {recorded_.inserted};
    state.integers["removed"] = {recorded_.removed};
  }
  return state;
}

void Flow::load(const StateBlock& state) {
  if (feed_) feed_->load(state);
  if (scene_.engine != EngineKind::replay) return;
  const auto& sums = saved_reals(state, "recorded");
  if (sums.size() != 4) throw IoError("the state of the recording is damaged");
  recorded_.mass_in_kg = sums[0], recorded_.mass_out_kg = sums[1];
  recorded_.heat_in_J = sums[2], recorded_.heat_out_J = sums[3];
  recorded_.inserted = saved_integer(state, "inserted");
  recorded_.removed = saved_integer(state, "removed");
}

/// Who was there before and is not after has left; who was not and is has come.
void Flow::follow_recording(Bed& bed, double time_s) {
  const Bed before = bed;
  engine_->advance(bed, time_s);
  const auto heat_J = [](const Bed& of, std::size_t i) {
    const auto& material = of.materials[static_cast<std::size_t>(of.material[i])];
    return mass_kg(of, i) * material.specific_heat_J_kgK * of.temperature_K[i];
  };
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (bed.index_of(before.id[i]) >= 0) continue;
    ++recorded_.removed;
    recorded_.mass_out_kg += mass_kg(before, i);
    recorded_.heat_out_J += heat_J(before, i);
  }
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (before.index_of(bed.id[i]) >= 0) continue;
    ++recorded_.inserted;
    recorded_.mass_in_kg += mass_kg(bed, i);
    recorded_.heat_in_J += heat_J(bed, i);
  }
}

void Flow::advance(Bed& bed, const TimePlan& plan, std::int64_t tick) {
  const std::int64_t last_step = plan.step_at(tick);
  if (!moves()) {
    bed.step = last_step;
    bed.time_s = plan.time_s(tick);
    return;
  }
  if (scene_.engine == EngineKind::replay) {
    if (!engine_) engine_ = make_engine(scene_, bed, plan.step_s, threads_);
    follow_recording(bed, plan.time_s(tick));
    bed.step = last_step;
    return;
  }
  if (feed_) feed_->update(bed);
  if (!engine_) engine_ = make_engine(scene_, bed, plan.step_s, threads_);
  if (records_touches_) engine_->record_touches();
  // Half a step early: the last step is the one at or after it, whatever rounding does.
  engine_->advance(bed, plan.time_s(tick) - 0.5 * plan.step_s);
  if (bed.step != last_step)
    throw NumericalError(fmt::format("the engine stopped at step {} instead of {}", bed.step, last_step));
  bed.time_s = plan.time_s(tick);
}

const NearPairs& Flow::near_pairs(const Bed& bed, double max_gap_m) {
  if (!moves() && bed.time_s < pairs_until_s_) return pairs_;
  pairs_ = engine_ ? engine_->near_pairs(bed, max_gap_m) : granrad::near_pairs(bed, max_gap_m);
  pairs_until_s_ = next_opening_s(bed.walls, bed.time_s);
  return pairs_;
}

}  // namespace granrad
