#pragma once
#include <string>

#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_model.h"
#include "coupling/simulation/recorder.h"
#include "coupling/simulation/time_plan.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// Wall-clock seconds spent in each part of a run.
struct PartSeconds {
  double flow = 0, conduction = 0, radiation = 0, output = 0;
};

/// Everything a run consists of at one instant; its frame holds all of it.
class Simulation {
 public:
  Simulation(const Case& c, int threads);
  /// Time 0: fills the bed, checks every limit. Throws InputError with every step that is too long.
  void start() { start(flow_.first_bed()); }
  void start(Bed bed);  ///< from a bed made elsewhere
  /// Goes on from a frame, bit for bit, or with other steps where the scene now asks for others. False, and
  /// nothing is done, where the end of a shorter run cut the frame's last heat step: a frame before it leads on.
  /// Throws InputError when the frame is of another scene or lacks something.
  bool resume(const Snapshot& frame);

  /// One tick: move, conduct, radiate when due, heat.
  void advance();
  Record record() { return recorder_.record(bed_, flow_, heat_); }
  void write_checkpoint(const std::filesystem::path& file) const;
  /// What a frame of this instant would hold; memory in `into` is used again.
  void keep(Snapshot& into) const;

  bool finished() const { return bed_.step >= plan_.end_step; }
  /// When the row before the present interval was made.
  double last_row_s() const { return recorder_.last_row_s(); }
  std::int64_t tick() const { return tick_; }
  const Bed& bed() const { return bed_; }
  const TimePlan& plan() const { return plan_; }
  bool moves() const { return flow_.moves(); }
  EngineThreads flow_threads() const { return flow_.threads(); }
  const StepLimits& limits() const { return limits_; }
  double conduction_limit_s() const { return conduction_limit_s_; }
  const HeatModel& heat() const { return heat_; }
  /// The heats of the bed as it is, by the source of the case (see HeatModel::draw_radiation).
  HeatModel::ParticleHeat draw_radiation(std::uint64_t draw) { return heat_.draw_radiation(bed_, draw); }
  FeedTotals fed() const { return flow_.totals(); }
  const PartSeconds& seconds() const { return seconds_; }
  void add_output_seconds(double seconds) { seconds_.output += seconds; }
  /// What start() found that is probably a mistake, or was done to the walls.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// Chooses the steps for the bed as it is.
  void make_plan();

  const Case& case_;
  std::int64_t identity_ = 0;  ///< of the case, in its frames
  Flow flow_;
  HeatModel heat_;
  Recorder recorder_;
  Bed bed_;
  StepLimits limits_{};
  double conduction_limit_s_ = 0;
  TimePlan plan_;
  std::int64_t tick_ = 0;
  PartSeconds seconds_;
  std::vector<std::string> notes_;
};

}  // namespace granrad
