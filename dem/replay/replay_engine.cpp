#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "dem/base/error.h"
#include "dem/engine_replay.h"
#include "dem/replay/recording.h"

namespace granrad {

namespace {

class ReplayEngine : public Engine {
 public:
  explicit ReplayEngine(const Scene& scene) : interpolated_(scene.replay.interpolated), recording_(scene) {}

  void advance(Bed& bed, double until_s) override {
    find(until_s);
    const bool later = after_ && until_s - before_.bed.time_s > after_->bed.time_s - until_s;
    const Bed& nearest = later ? after_->bed : before_.bed;
    if (!placed_ || nearest.time_s != shown_s_) {
      take_particles(bed, nearest);
      shown_s_ = nearest.time_s;
      placed_ = true;
      ++generation_;
    }
    if (interpolated_ && after_) {
      place_between(bed, until_s);
      ++generation_;
    }
    bed.time_s = until_s;
  }

  NearPairs near_pairs(const Bed& bed, double max_gap_m) override {
    if (pairs_of_ != generation_ || gap_m_ != max_gap_m || bed.time_s >= pairs_until_s_) {
      pairs_ = granrad::near_pairs(bed, max_gap_m);
      pairs_of_ = generation_;
      gap_m_ = max_gap_m;
      pairs_until_s_ = next_opening_s(bed.walls, bed.time_s);
    }
    return pairs_;
  }

 private:
  /// The snapshots before and after a time.
  void find(double time_s) {
    if (!started_ || time_s < before_.bed.time_s) {
      recording_.rewind();
      before_ = *recording_.next();
      after_ = recording_.next();
      started_ = true;
      placed_ = false;
    }
    while (after_ && after_->bed.time_s <= time_s) {
      before_ = std::move(*after_);
      after_ = recording_.next();
    }
  }

  /// Those of the snapshot, with the temperatures and heats of the particles that were there before.
  static void take_particles(Bed& bed, const Bed& shown) {
    std::vector<char> stays(bed.size());
    for (std::size_t i = 0; i < bed.size(); ++i) stays[i] = shown.index_of(bed.id[i]) >= 0;
    bed.remove_unless(stays);
    const std::size_t known = bed.size();
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto at =
          std::lower_bound(bed.id.begin(), bed.id.begin() + static_cast<std::ptrdiff_t>(known), shown.id[i]);
      if (at != bed.id.begin() + static_cast<std::ptrdiff_t>(known) && *at == shown.id[i]) continue;
      bed.add(shown.position_m[i], shown.velocity_m_s[i], shown.radius_m[i], shown.temperature_K[i],
              shown.material[i]);
      bed.id.back() = shown.id[i];
    }
    std::vector<std::size_t> order(bed.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return bed.id[a] < bed.id[b]; });
    bed.permute(order);
    bed.next_id = bed.size() > 0 ? bed.id.back() + 1 : 1;
    bed.position_m = shown.position_m;  // both stand in ascending id
    bed.velocity_m_s = shown.velocity_m_s;
    bed.angular_velocity_rad_s = shown.angular_velocity_rad_s;
    bed.radius_m = shown.radius_m;
    bed.material = shown.material;
    bed.contacts.clear();
  }

  /// Moves the particles that are in both snapshots; the others stay where the nearest has them.
  void place_between(Bed& bed, double time_s) const {
    const Bed &a = before_.bed, &b = after_->bed;
    const double part = (time_s - a.time_s) / (b.time_s - a.time_s);
    for (std::size_t i = 0; i < bed.size(); ++i) {
      const auto j = a.index_of(bed.id[i]), k = b.index_of(bed.id[i]);
      if (j < 0 || k < 0) continue;
      const auto from = static_cast<std::size_t>(j), to = static_cast<std::size_t>(k);
      bed.position_m[i] =
          a.position_m[from] + part * nearest_image(bed, b.position_m[to] - a.position_m[from]);
      bed.velocity_m_s[i] = (1 - part) * a.velocity_m_s[from] + part * b.velocity_m_s[to];
    }
  }

  bool interpolated_, started_ = false, placed_ = false;
  Recording recording_;
  Snapshot before_;
  std::optional<Snapshot> after_;
  double shown_s_ = 0, gap_m_ = -1, pairs_until_s_ = 0;  ///< until a shutter opens
  std::int64_t generation_ = 0, pairs_of_ = -1;
  NearPairs pairs_;
};

}  // namespace

double recorded_s(const Scene& scene) {
  const double radius_m = 0.5 * scene.particle_diameter_m;
  const auto time_s = [&](const std::filesystem::path& file, SnapshotChoice::Kind kind) {
    return recorded_time_s(read_snapshot(file, radius_m, {kind}), scene);
  };
  return time_s(scene.replay.files.back(), SnapshotChoice::Kind::last) -
         time_s(scene.replay.files.front(), SnapshotChoice::Kind::first);
}

std::unique_ptr<Engine> make_replay_engine(const Scene& scene) {
  return std::make_unique<ReplayEngine>(scene);
}

}  // namespace granrad
