#pragma once
#include <memory>

#include "dem/scene/bed.h"
#include "dem/scene/scene.h"
#include "dem/scene/snapshot.h"

namespace granrad {

/// What came in and went out since time 0.
struct FeedTotals {
  double mass_in_kg = 0, mass_out_kg = 0;
  double heat_in_J = 0, heat_out_J = 0;  ///< m c T of the particles inserted (start excluded) and removed
  std::int64_t inserted = 0, removed = 0;
};

/// Inserts and removes particles between engine calls. Deterministic: what it does depends on the scene, the
/// Bed and its saved state only.
class Feed {
 public:
  explicit Feed(const Scene& scene);
  ~Feed();
  /// The filling at time 0 (plug: channel full of the relaxed column unless start_filled is off).
  void start(Bed& bed);
  /// Removes what has left and inserts what is due at bed.time_s.
  void update(Bed& bed);
  const FeedTotals& totals() const;

  StateBlock save() const;
  void load(const StateBlock& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad
