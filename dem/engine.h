#pragma once
#include <optional>

#include "dem/bed/bed.h"
#include "dem/bed/near_pairs.h"
#include "dem/bed/touches.h"

namespace granrad {

/// Threads an engine works with now, of those it may use.
struct EngineThreads {
  int used = 1, most = 1;
};

/// Moves particles: turns a Bed into a later Bed. One of the two virtual seams of the project.
///
/// Contract: everything the future depends on stands in the Bed (positions, velocities, contact memory,
/// step count), so that advancing a Bed read back from disk gives the same bits as never having stopped,
/// for any number of threads. Temperature and heat columns stay aligned with the id and are not read.
class Engine {
 public:
  virtual ~Engine() = default;

  /// Advances `bed` by whole steps to the first step at or after `until_s`.
  /// Throws NumericalError when a particle tunnels, leaves double range or overlaps beyond the model.
  virtual void advance(Bed& bed, double until_s) = 0;

  /// As near_pairs(bed, max_gap_m) for the bed that `advance` left, without a second search where the
  /// engine still holds its list.
  virtual NearPairs near_pairs(const Bed& bed, double max_gap_m) = 0;

  /// Asks for `touches` of every advance from now on.
  virtual void record_touches() {}
  /// How bodies touched during the last `advance`, which left this bed; nothing where the engine does not record it.
  virtual std::optional<Touches> touches(const Bed&) const { return {}; }

  virtual EngineThreads threads() const { return {}; }
};

}  // namespace granrad
