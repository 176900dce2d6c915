#pragma once
#include <memory>

#include "dem/bed/bed.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"

namespace granrad {

/// What came in and went out since time 0; the filling at time 0 is not counted.
struct FeedTotals {
  double mass_in_kg = 0, mass_out_kg = 0;
  double heat_in_J = 0, heat_out_J = 0;  ///< m c T of the particles inserted and removed
  double heat_capacity_out_J_K = 0;      ///< m c of those removed
  std::int64_t inserted = 0, removed = 0;
  std::int64_t nudged = 0;   ///< of the inserted: moved aside because their place was taken
  std::int64_t waiting = 0;  ///< due now, but without a free place so far (carried to the next update)
};

/// Inserts and removes particles between engine calls; takes out what comes into a [[remove]] place as well. Deterministic: what it does depends on the scene, the
/// Bed and its saved state only. With `engine = "none"` the filling at time 0 is all that happens.
/// How particles come and go: dem/feed/plug_feed.h, dem/feed/hopper_feed.h.
class Feed {
 public:
  /// Throws InputError when the scene's feed cannot work (solid fraction out of reach, no speed, no room).
  explicit Feed(const Scene& scene);
  ~Feed();
  Feed(Feed&&) noexcept;
  Feed& operator=(Feed&&) noexcept;

  /// The filling at time 0; a bed that already has particles (from a file) is left as it is.
  void start(Bed& bed);
  /// Removes what has left and inserts what is due at bed.time_s. Call it often enough that particles move
  /// less than a radius in between.
  void update(Bed& bed);
  const FeedTotals& totals() const;

  StateBlock save() const;
  void load(const StateBlock& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad
