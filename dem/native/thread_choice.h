#pragma once
#include <cstdint>

namespace granrad::native {

/// One thread or several: chosen by what a step costs in the run itself. On a machine with other work, threads
/// that wait for each other twice a step can be many times slower than one alone; and what else runs there comes
/// and goes. So each is tried for some milliseconds, the faster is kept, and the other is tried again now and
/// then: soon after a change, ever more seldom while nothing changes. One goes first. Results do not depend on it.
class ThreadChoice {
 public:
  /// Between 1 and `most`; with `fixed` always `most`.
  explicit ThreadChoice(int most, bool fixed = false);

  int threads() const { return several_ ? most_ : 1; }
  int most() const { return most_; }
  /// Whether the number is being tried: work should come in short pieces then.
  bool tries() const { return most_ > 1 && phase_ != Phase::keep; }
  /// Steps to do at most before reporting.
  std::int64_t longest_piece(std::int64_t steps) const { return tries() && steps > piece ? piece : steps; }
  /// `steps` were done in the `seconds` before `now_s` (any clock).
  void spent(std::int64_t steps, double seconds, double now_s);

 private:
  enum class Phase { first, second, keep };  ///< of a trial: this number, then the other; then the faster
  struct Cost {
    double seconds = 0;
    std::int64_t steps = 0, pieces = 0;
    double each() const { return steps > 0 ? seconds / double(steps) : 0; }
  };
  bool is_due(double now_s) const;
  void start_trial();
  void turn_to(bool several);
  void decide(double now_s);

  static constexpr std::int64_t piece = 8;
  int most_;
  bool fixed_, several_;
  Phase phase_ = Phase::first;
  Cost cost_[2];          ///< of one thread, of several; in this trial
  Cost recent_;           ///< since the last look at it
  double kept_cost_ = 0;  ///< s a step, when it was chosen
  double wait_s_ = 0, chosen_at_s_ = 0, trial_s_ = 0;
  bool cold_ = true;  ///< the next piece pays for new lists
};

}  // namespace granrad::native
