#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

#include "dem/base/error.h"
#include "dem/ranks/ranks.h"

namespace granrad {

/// Told now and then, from the thread that started the trace, which part of the present round is done (0 ..
/// 1); answers whether to go on. When not, the trace ends with TraceStopped.
using TraceWatch = std::function<bool(double part)>;

/// A trace was stopped by its watch; nothing of it is kept.
class TraceStopped : public NumericalError {
 public:
  TraceStopped() : NumericalError("tracing stopped before its end: nothing was kept") {}
};

/// Counts the work that several threads have done and asks the watch whether to go on; a signal to the program stops
/// it as well. Of several ranks each counts its own part.
class RayMonitor {
 public:
  /// `total` of all ranks.
  RayMonitor(TraceWatch watch, double total) : watch_(std::move(watch)), total_(total / rank_count()) {}

  /// To be called by any thread with the work it begins; false: stop.
  bool go_on(std::int64_t work);
  /// To be called by every rank: where one was stopped, all are.
  void throw_if_stopped() const {
    // Without a watch only a process that is alone stops: nobody waits for it.
    if (watch_ ? largest_over_ranks(stopped_) != 0 : stopped_.load()) throw TraceStopped();
  }

 private:
  TraceWatch watch_;
  double total_;
  std::atomic<std::int64_t> done_{0};
  std::atomic<bool> stopped_{false};
};

}  // namespace granrad
