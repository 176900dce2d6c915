// Requirement: one thread or several, whichever makes steps cheaper at the time; trials cost little.
//
// The choice is fed with what steps of a machine that is only a formula cost. Planted: the dearer is kept; a trial
// that never ends where pieces are long; no second look.
#include "dem/native/thread_choice.h"

#include <gtest/gtest.h>

namespace granrad::native {
namespace {

/// Steps for `until` seconds of a made-up clock; returns the share of steps' time spent with several threads.
struct Machine {
  double now_s = 0, steps = 0;
  template <class Cost>
  double run(ThreadChoice& choice, double until_s, Cost seconds_per_step) {
    double several = 0;
    const double start = now_s;
    while (now_s < until_s) {
      const auto n = choice.longest_piece(48);
      const bool many = choice.threads() > 1;
      const double spent = double(n) * seconds_per_step(many);
      now_s += spent, steps += double(n);
      several += many ? spent : 0;
      choice.spent(n, spent, now_s);
    }
    return several / (now_s - start);
  }
};

TEST(ThreadChoice, keeps_the_faster_and_looks_again) {
  ThreadChoice choice(2);
  Machine machine;
  EXPECT_EQ(choice.threads(), 1);  // safe until it is known better
  EXPECT_GT(machine.run(choice, 10, [](bool many) { return many ? 40e-6 : 70e-6; }), 0.95);
  // Another program comes: two threads wait for each other, a step takes milliseconds.
  machine.run(choice, 12, [](bool many) { return many ? 4e-3 : 80e-6; });
  EXPECT_EQ(choice.threads(), 1);
  EXPECT_LT(machine.run(choice, 60, [](bool many) { return many ? 4e-3 : 80e-6; }), 0.03);
  // It leaves.
  machine.run(choice, 130, [](bool many) { return many ? 40e-6 : 70e-6; });
  EXPECT_EQ(choice.threads(), 2);
}

TEST(ThreadChoice, leaves_alone_what_is_fixed_or_single) {
  Machine machine;
  ThreadChoice fixed(4, true), single(1);
  EXPECT_EQ(fixed.longest_piece(48), 48);
  machine.run(fixed, 1, [](bool many) { return many ? 1e-3 : 1e-5; });
  EXPECT_EQ(fixed.threads(), 4);
  machine.run(single, 2, [](bool) { return 1e-5; });
  EXPECT_EQ(single.threads(), 1);
  EXPECT_EQ(single.longest_piece(48), 48);
}

}  // namespace
}  // namespace granrad::native
