#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/native/grid.h"
#include "dem/native/model.h"
#include "dem/native/near_search.h"
#include "dem/native/share.h"

namespace granrad::native {

/// How often lists are made anew; results do not depend on it.
struct ListSchedule {
  int refresh_every = 48;  ///< steps a tight list is made to live; up to twice that where little moves
  int rebuild_every =
      0;  ///< 0: near lists when someone has moved through the skin; else also every so many steps
};

/// Touches by Bed index, in no order; one pair may come several times.
struct RecordedTouches {
  std::vector<TouchSum> particles, walls;
};

/// Keeps the near and tight lists of all threads in step with the rows.
class ContactLists {
 public:
  ContactLists(const Kernels& kernels, int threads, ListSchedule schedule);

  /// Forgets the lists; springs come from `memories` when they are made again.
  void restart(std::vector<Memory> memories);
  /// Deals the rows out to this many shares when lists are made next, which is before the next step.
  void deal(int threads, const Rows& rows, const WallSurface& surface);
  /// Touches recorded since clear_touches, where StepConstants::touch_units asks for them.
  RecordedTouches touches(const Rows& rows, const WallSurface& surface) const;
  void clear_touches();
  /// Positions or velocities were changed from outside.
  void touch() { life_ = 0; }
  void walls_changed() { walls_stale_ = true, life_ = 0; }
  /// Makes the lists good for at least one step; sets reaches and speed limits in the rows. Returns the steps
  /// they are good for while no speed limit is broken. Throws NumericalError for a tunnelling particle.
  std::int64_t prepare(Rows& rows, Model& model, const Periods& periods, const Bed& bed,
                       const WallSurface& surface);
  /// `steps` were done; `limit_broken`: the lists must be refreshed whatever was promised.
  void spend(std::int64_t steps, bool limit_broken);

  int threads() const { return static_cast<int>(shares_.size()); }
  std::vector<Share>& shares() { return shares_; }
  const std::vector<Share>& shares() const { return shares_; }
  /// Someone reads the near lists: those made from now on stay complete for this gap as long as they live.
  void keep_complete_to(double gap_m) { asked_gap_m_ = std::max(asked_gap_m_, gap_m); }
  /// Gaps up to which the near lists are complete for the positions now in the rows; negative: not at all.
  struct CompleteGaps {
    double particles_m = -1, walls_m = -1;
  };
  CompleteGaps complete_gaps(const Rows& rows) const;
  std::size_t bytes() const;
  std::int64_t rebuilds = 0, refreshes = 0;  ///< for the bench

 private:
  /// Distances that may still be moved before a list no longer holds, m; negative: it does not.
  struct Slack {
    double near_m, walls_m;
    double least_m() const { return std::min(near_m, walls_m); }
  };
  /// Steps the next tight lists should live.
  std::int64_t wanted_life(double largest_radius) const;
  std::vector<Memory> collect(const Rows& rows) const;
  double margin_of(double speed, std::int64_t steps) const;
  void anticipate(Rows& rows, Model& model, const Periods& periods, const WallSurface& surface,
                  std::int64_t steps);
  Slack slack_of(const Rows& rows, std::int64_t i, const Vec3& moved) const;
  /// The least of any row after `steps` more.
  Slack measure_slack(const Rows& rows, std::int64_t steps) const;
  /// Throws for a particle that tunnels; finds the usual speed.
  void survey_speeds(const Rows& rows, const Bed& bed);
  void set_reaches(Rows& rows, std::int64_t steps);
  bool rebuild_is_due(const Slack& slack) const;
  /// Makes the near lists anew, in rows sorted anew.
  void rebuild(Rows& rows, const Model& model, const Periods& periods, const Bed& bed,
               const WallSurface& surface, std::int64_t steps);
  static void visit_touches(const Share& share, const Rows& rows, const WallSurface& surface,
                            RecordedTouches& out);
  void set_touches_aside(const Rows& rows, const WallSurface& surface);
  void sort_rows(Rows& rows, const Periods& periods, const Bed& bed, double cell_m);
  /// Hands the springs at walls to the shares that own their rows.
  void restore_walls(const Rows& rows);
  void choose_skins(const Rows& rows, double largest_radius, std::int64_t steps);
  void find_walls(const Rows& rows, const Periods& periods, const WallSurface& surface);
  void refresh(Rows& rows, const Model& model, const Periods& periods, const Bed& bed,
               const WallSurface& surface, std::int64_t steps);
  Vec3 drift() const { return mean_velocity_ * (step_s_ * double(steps_since_sort_)); }

  const Kernels& kernels_;
  ListSchedule schedule_;
  std::vector<Share> shares_;
  Grid grid_;
  MemoryTable memory_table_;
  std::vector<Memory> memories_;
  RecordedTouches touched_;                        ///< of lists that are no more
  std::vector<double> near_origin_, wall_origin_;  ///< [3 n] where the rows were when the list was made
  std::vector<double> closing_;                    ///< [n + idle rows] see PairList::find_closing_speeds
  Skins skins_;
  Vec3 mean_velocity_{};
  double step_s_ = 0, spare_speed_m_s_ = 0;
  double usual_speed_m_s_ = 0;  ///< mean of the rows' speeds beside the mean velocity
  double asked_gap_m_ = -1, listed_gap_m_ = 0, listed_wall_gap_m_ = 0;  ///< gaps that outlive the skin
  std::int64_t life_ = 0, promised_ = 0, steps_since_sort_ = 0;
  bool has_walls_ = true;
  bool stale_ = true, walls_stale_ = true;
};

}  // namespace granrad::native
