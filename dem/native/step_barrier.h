#pragma once
#include <atomic>

namespace granrad::native {

/// Where the threads of a step wait for each other. They spin for about as long as their shares of the work
/// differ, then sleep: on a busy machine a spinning thread keeps the very one it waits for from running
/// (OpenMP's own barrier spins for milliseconds, many steps' worth).
class StepBarrier {
 public:
  explicit StepBarrier(int threads) : threads_(threads) {}

  void wait() {
    if (threads_ == 1) return;
    const int round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      arrived_.store(0, std::memory_order_relaxed);
      round_.store(round + 1, std::memory_order_release);
      round_.notify_all();
      return;
    }
    for (int k = 0; k < spins; ++k) {
      if (round_.load(std::memory_order_acquire) != round) return;
      relax();
    }
    round_.wait(round, std::memory_order_acquire);
  }

 private:
  static constexpr int spins = 4000;  ///< some 50 us
  static void relax() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  const int threads_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<int> round_{0};
};

}  // namespace granrad::native
