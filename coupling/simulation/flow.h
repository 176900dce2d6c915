#pragma once
#include <memory>

#include "coupling/simulation/time_plan.h"
#include "dem/base/constants.h"
#include "dem/engine.h"
#include "dem/feed/feed.h"

namespace granrad {

/// What moves the bed in a run: feed and engine, a recording, or nothing (a frozen bed).
class Flow {
 public:
  explicit Flow(const Scene& scene, int threads = 0);
  /// The bed at time 0: particles of the scene's file, filled by the feed.
  Bed first_bed();

  /// Feeds, then moves to the end of `tick`. Throws NumericalError.
  void advance(Bed& bed, const TimePlan& plan, std::int64_t tick);
  /// Pairs within the gap, from the engine's own list; found once in a frozen bed.
  const NearPairs& near_pairs(const Bed& bed, double max_gap_m);
  /// Whether near_pairs of a moving bed searches anew each time: ranks may share that.
  bool searches_pairs() const {
    return scene_.engine == EngineKind::liggghts || scene_.engine == EngineKind::replay;
  }
  /// Has the engine record what touches, for `touches`; before the first advance.
  void record_touches(bool wanted) { records_touches_ = wanted; }
  /// How bodies touched since the last tick; nothing in a frozen bed, and from an engine that does not say.
  std::optional<Touches> touches(const Bed& bed) const {
    return engine_ ? engine_->touches(bed) : std::nullopt;
  }
  /// Threads the engine works with; of a frozen bed 1 of 1.
  EngineThreads threads() const { return engine_ ? engine_->threads() : EngineThreads{}; }
  bool moves() const { return scene_.engine != EngineKind::none; }

  FeedTotals totals() const { return feed_ ? feed_->totals() : recorded_; }
  StateBlock save() const;
  void load(const StateBlock& state);

 private:
  void follow_recording(Bed& bed, double time_s);

  const Scene& scene_;
  int threads_;
  std::unique_ptr<Feed> feed_;
  FeedTotals recorded_;             ///< what came and went in a recording
  std::unique_ptr<Engine> engine_;  ///< made at the first advance, when the bed is known
  NearPairs pairs_;
  double pairs_until_s_ = -infinity;  ///< of a frozen bed: until a shutter opens
  bool records_touches_ = false;
};

}  // namespace granrad
