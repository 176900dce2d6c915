#pragma once
#include <cstdint>
#include <vector>

namespace granrad {

/// How often the rays of a surface ended on one other.
struct HitEntry {
  std::int32_t surface = -1;
  std::int64_t hits = 0;
  double replicate_square_sum = 0;  ///< sum over replicates of (hits in it)^2
};

/// Counts the hits of one surface at a time. Memory: 20 bytes per surface of the enclosure, for one per
/// thread.
class HitTally {
 public:
  explicit HitTally(std::size_t surfaces)
      : total_(surfaces, 0), current_(surfaces, 0), square_(surfaces, 0) {}

  void add(std::int32_t surface, std::int32_t hits = 1) {
    std::int32_t& current = current_[static_cast<std::size_t>(surface)];
    if (current == 0) touched_.push_back(surface);
    current += hits;
  }
  /// Hits of the present replicate on the surfaces marked in `wanted`.
  std::int64_t hits_on(const std::vector<char>& wanted) const;
  /// Calls visit(surface, hits) for those of the present replicate.
  template <class Visit>
  void visit_current(Visit&& visit) const {
    for (const std::int32_t s : touched_) visit(s, current_[static_cast<std::size_t>(s)]);
  }
  /// Ends one replicate: what was added since the last one counts as one independent estimate.
  void end_replicate();
  /// The entries of the surface just counted, ascending; leaves the tally empty for the next one.
  std::vector<HitEntry> take();

 private:
  std::vector<std::int64_t> total_;
  std::vector<std::int32_t> current_;
  std::vector<double> square_;
  std::vector<std::int32_t> touched_, seen_;
};

}  // namespace granrad
