#include "dem/native/thread_choice.h"

#include <algorithm>

namespace granrad::native {
namespace {

constexpr double enough_s = 4e-3;          ///< of work tell what a number of threads costs,
constexpr std::int64_t enough_pieces = 2;  ///< and at least these
constexpr double clearly = 0.95;           ///< the other must be faster by this to be taken
constexpr double first_wait_s = 0.5, longest_wait_s = 30;
constexpr double trial_share = 0.02;  ///< of the time, at most, goes into trials
constexpr double much_dearer = 1.5;   ///< a step than when it was chosen: look again
constexpr double look_s = 0.1;        ///< how much work is looked at for that

}  // namespace

ThreadChoice::ThreadChoice(int most, bool fixed)
    : most_(most), fixed_(fixed), several_(fixed && most > 1), wait_s_(first_wait_s) {
  if (fixed_ || most_ == 1) phase_ = Phase::keep;
}

void ThreadChoice::turn_to(bool several) {
  cold_ = several_ != several;
  several_ = several;
}

void ThreadChoice::start_trial() {
  cost_[0] = cost_[1] = {};
  trial_s_ = 0;
  phase_ = Phase::first;
  cold_ = false;
}

void ThreadChoice::decide(double now_s) {
  const bool before = !several_;  // the trial ended with the other
  const bool other = cost_[several_].each() < clearly * cost_[before].each();
  const bool chosen = other ? several_ : before;
  wait_s_ = other ? first_wait_s : std::min(2 * wait_s_, longest_wait_s);
  wait_s_ = std::max(wait_s_, trial_s_ / trial_share);
  kept_cost_ = cost_[chosen].each();
  chosen_at_s_ = now_s;
  recent_ = {};
  phase_ = Phase::keep;
  turn_to(chosen);
}

bool ThreadChoice::is_due(double now_s) const {
  const double passed_s = now_s - chosen_at_s_;
  if (passed_s > wait_s_) return true;
  const bool dearer = recent_.seconds >= look_s && recent_.each() > much_dearer * kept_cost_;
  return dearer && passed_s > std::max(first_wait_s, trial_s_ / trial_share);
}

void ThreadChoice::spent(std::int64_t steps, double seconds, double now_s) {
  if (fixed_ || most_ == 1) return;
  if (phase_ == Phase::keep) {
    recent_.seconds += seconds, recent_.steps += steps;
    if (is_due(now_s)) return start_trial();
    if (recent_.seconds >= look_s) recent_ = {};
    return;
  }
  trial_s_ += seconds;
  if (cold_) {
    cold_ = false;
    return;
  }
  Cost& cost = cost_[several_];
  cost.seconds += seconds, cost.steps += steps, ++cost.pieces;
  if (cost.seconds < enough_s || cost.pieces < enough_pieces) return;
  if (phase_ == Phase::second) return decide(now_s);
  phase_ = Phase::second;
  turn_to(!several_);
}

}  // namespace granrad::native
