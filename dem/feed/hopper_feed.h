#pragma once
#include "dem/feed/feed.h"

namespace granrad {

class Columns;

/// Moving bed: `particle_count` spheres poured into `fill_region`, leaving below `remove_below_m`.
///
/// Start: a random packing from the bottom of the region up (solid fraction `solid_fraction`, default 0.5),
/// moving down with `velocity_m_s`, to be settled by the engine; what the region cannot hold is dropped
/// later. Refill: the bed is kept at `particle_count`. Each missing sphere is set down cold at a random place
/// of the region, just above the highest sphere there (heap or falling spheres), so it never overlaps; when
/// the region is full there, it waits. `mass_flow_kg_s` > 0 caps the rate, counted from the start.
/// `refill = false`: one batch, until `particle_count` ids are used. Poured (`rate_1_s` > 0): nothing at the start,
/// then `rate_1_s` spheres a second until `particle_count` have come (with `refill`: are there). Layers too thin for the
/// solid fraction start looser, down to single spheres.
///
/// Places are keyed by the id of the sphere to come, so without a cap all it does follows from the Bed: a run
/// that starts from a filled bed (`[particles] file`) goes on bit for bit like the one that filled it.
class HopperFeed {
 public:
  explicit HopperFeed(const Scene& scene);
  void start(Bed& bed);
  double leaves_below_m() const { return settings_.remove_below_m; }
  void insert_due(Bed& bed, FeedTotals& totals);
  void save(StateBlock& state) const;
  void load(const StateBlock& state);

 private:
  std::int64_t due(const Bed& bed, const FeedTotals& totals) const;
  bool pack(Bed& bed, double solid_fraction) const;
  bool drop_one(Bed& bed, Columns& columns) const;
  void add(Bed& bed, const Vec3& position) const;

  FeedSettings settings_;
  double radius_, temperature_, density_;
  double start_s_ = 0;
};

}  // namespace granrad
