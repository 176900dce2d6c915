#pragma once
#include <cstdint>
#include <vector>

#include "dem/ranks/ranks.h"
#include "raytrace/exchange.h"
#include "raytrace/line_pass/line_events.h"

namespace granrad {

/// Symmetric counts of neighbours on lines, with the variance of each found between replicates.
struct SymmetricCounts {
  SparsePattern pattern;
  std::vector<std::int64_t> count;
  std::vector<double> variance;
  int thinning_unit = 1;
  ReplicateSamples
      replicates{};  ///< counts of each pair once, in each replicate; empty: too many, or thinned
};

/// Counts S_ij, the lines on which surfaces i and j follow each other, as sorted lists of pairs i <= j (i =
/// j: images of one sphere). Threads gather events by blocks of rows; now and then each block's events are
/// sorted and merged into its list, all in the cache. Integer sums: the result does not depend on the order
/// of events or on threads. Of several ranks each keeps a part of the blocks: at each merge events go to the rank that
/// keeps their block, and `finish` gives all blocks to all.
class PairCounts {
 public:
  /// Bytes at the peak for each pair held: both halves of the result, and what they are made from.
  static constexpr std::size_t bytes_per_pair = 64;
  /// Bytes for each event between two merges: its key, and the pair it may become.
  static constexpr std::size_t bytes_per_event = 16;

  /// `kind` (0 or 1) of each surface separates the pools of pairs whose variances are compared: between
  /// replicates each pair has too few degrees of freedom, so the ratio variance / count is pooled over pairs
  /// of like kinds and of counts within a factor of two; in large enclosures over the pairs of a sample of 1
  /// in 16 surfaces of kind 0 (kind 1 with kind 1: all). Beyond `max_pairs` thinning starts. `events`: about
  /// how many to expect between two merges.
  PairCounts(std::vector<char> kind, std::size_t max_pairs, double events, int threads);

  /// Where one thread of the team puts what it finds.
  PairEvents& events(int thread) { return events_[static_cast<std::size_t>(thread)]; }

  /// To be called by every thread of a team, after a barrier behind the last event; so is end_replicate.
  /// Counts the events, then thins when there are too many pairs: those with n < unit counts stay with
  /// probability n / unit and then count as unit; which is drawn from (seed, i, j, round of thinning). The
  /// unit is doubled when thinning by the present one is not enough.
  void merge(std::uint64_t seed);
  /// Ends one independent randomisation.
  void end_replicate();
  SymmetricCounts finish();

 private:
  struct PairCount {
    std::uint32_t key, count;
  };
  struct Sample {
    std::uint32_t key;
    std::uint32_t total;  ///< at the end of the last replicate
    float spread;         ///< sum over the replicates of (count - mean)^2
  };
  struct Block {
    std::vector<PairCount> pairs;              ///< keys ascend
    std::vector<Sample> samples;               ///< of those in sampled rows
    std::vector<std::vector<PairCount>> ends;  ///< the pairs at the end of each replicate
  };
  struct Scratch {
    std::vector<std::uint32_t> events, room;
    std::vector<PairCount> found, merged;
  };
  struct Expanded;
  struct VariancePools;

  RankPart own_blocks() const { return part_of_rank(static_cast<std::int64_t>(blocks_.size())); }
  void send_events();
  void add_pairs(std::size_t of_thread);
  void share_blocks();
  void count_events(std::size_t block, Scratch& scratch);
  std::size_t thin(std::size_t block, std::uint64_t seed);  ///< returns what is left
  void sample(std::size_t block);
  bool sampled(std::size_t row) const;
  VariancePools pooled_variances() const;
  ReplicateSamples replicates() const;
  void add_replicate(std::size_t block, std::size_t replicate, std::vector<ReplicateSample>& samples) const;
  Expanded expand();

  PairPacking packing_;
  std::vector<char> kind_;
  std::vector<Block> blocks_;
  std::vector<PairEvents> events_;
  std::vector<std::vector<std::uint32_t>> arrived_;  ///< [own block] events that other ranks found
  std::size_t max_pairs_, pairs_ = 0;
  int replicates_ = 0, unit_ = 1;
  std::uint32_t thinning_round_ = 0;
};

}  // namespace granrad
