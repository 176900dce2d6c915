#include "coupling/simulation/flow.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/engine_liggghts.h"
#include "dem/engine_native.h"

namespace granrad {

namespace {

std::unique_ptr<Engine> make_engine(const Scene& scene, const Bed& bed, double step_s, int threads) {
  if (scene.engine == EngineKind::liggghts) return make_liggghts_engine(scene.gravity_m_s2, step_s);
  return make_native_engine(bed, scene.gravity_m_s2, step_s, threads, scene.precision);
}

}  // namespace

Flow::Flow(const Scene& scene, int threads) : scene_(scene), threads_(threads) {
  if (scene.feed.kind != FeedSettings::Kind::none) feed_ = std::make_unique<Feed>(scene);
}

Bed Flow::first_bed() {
  Bed bed = initial_bed(scene_);
  bed.time_s = 0;
  bed.step = 0;
  if (feed_) feed_->start(bed);
  return bed;
}

void Flow::load(const StateBlock& state) {
  if (feed_) feed_->load(state);
}

void Flow::advance(Bed& bed, const TimePlan& plan, std::int64_t tick) {
  const std::int64_t last_step = plan.step_at(tick);
  if (!moves()) {
    bed.step = last_step;
    bed.time_s = plan.time_s(tick);
    return;
  }
  if (feed_) feed_->update(bed);
  if (!engine_) engine_ = make_engine(scene_, bed, plan.step_s, threads_);
  // Half a step early: the last step is the one at or after it, whatever rounding does.
  engine_->advance(bed, plan.time_s(tick) - 0.5 * plan.step_s);
  if (bed.step != last_step)
    throw NumericalError(fmt::format("the engine stopped at step {} instead of {}", bed.step, last_step));
  bed.time_s = plan.time_s(tick);
}

const NearPairs& Flow::near_pairs(const Bed& bed, double max_gap_m) {
  if (pairs_known_ && !moves()) return pairs_;
  pairs_ = engine_ ? engine_->near_pairs(bed, max_gap_m) : granrad::near_pairs(bed, max_gap_m);
  pairs_known_ = true;
  return pairs_;
}

}  // namespace granrad
