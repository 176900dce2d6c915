#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "raytrace/exchange.h"

namespace granrad {

/// Symmetric counts of neighbours on lines, with the variance of each found between replicates.
struct SymmetricCounts {
  SparsePattern pattern;
  std::vector<std::int64_t> count;
  std::vector<double> variance;
  int thinning_unit = 1;
};

/// Sums "surface j came before surface i on a line" into sparse rows i, from several threads at once.
/// Integer sums: the result does not depend on the order of additions. Rows are hash tables that see their
/// additions in bunches, so that a row is in the cache while it is worked on.
class PairCounts {
 public:
  /// One row per surface; `kind` (0 or 1) separates the pools of pairs whose variances are compared: between
  /// replicates each pair has too few degrees of freedom, so the ratio variance / count is pooled over pairs
  /// of like kinds and of counts within a factor of two; in large enclosures over a sample of 1 in 16 (pairs
  /// of kind 1 with kind 1: all). Rows may hold `max_entries` pairs (i, j) between them before thinning
  /// starts.
  PairCounts(std::vector<char> kind, std::size_t max_entries);

  /// Bunches additions for one thread: predecessors wait in short rows until there are enough.
  class Buffer {
   public:
    Buffer(PairCounts& counts, std::size_t memory_bytes);
    /// Adds `n` <= bunch() predecessors of `surface`.
    void append(std::int32_t surface, const std::int32_t* predecessors, std::int32_t n) {
      const auto row = static_cast<std::size_t>(surface);
      if (fill_[row] + n + 16 > bunch_) flush(row);
      std::int32_t* to = waiting_.data() + row * bunch_ + fill_[row];
      for (std::int32_t k = 0; k < n; ++k) to[k] = predecessors[k];
      fill_[row] += n;
    }
    void prefetch(std::int32_t surface) const {
      const std::int32_t* to = waiting_.data() + static_cast<std::size_t>(surface) * bunch_ + fill_[surface];
      __builtin_prefetch(to, 1);
      __builtin_prefetch(to + 15, 1);
    }
    std::int32_t bunch() const { return bunch_ - 16; }
    void flush();

   private:
    void flush(std::size_t row);
    PairCounts& counts_;
    std::int32_t bunch_;
    std::vector<std::int32_t> waiting_, fill_;
    std::vector<std::int32_t> multiplicity_, distinct_;  // of the row being flushed
  };

  /// To be called by every thread of a team, after a barrier behind the last flush; so is end_replicate.
  /// Thins when there are too many pairs: those with n < unit counts stay with probability n / unit and then
  /// count as unit; which is drawn from (seed, i, j, unit).
  void keep_within_limit(std::uint64_t seed);
  /// Ends one independent randomisation.
  void end_replicate();
  /// S = C + C^T with variances.
  SymmetricCounts finish();

 private:
  struct Entry {
    std::int32_t id;
    std::int32_t current;  ///< this replicate
    std::uint32_t total;   ///< replicates before
    float spread;          ///< sum of (S - mean)^2 over them, S the count in both orders
  };
  struct Row {
    std::vector<Entry> slots;  ///< open addressing, size a power of two; id -1: free
    std::size_t used = 0;
  };
  struct Lock {
    std::atomic_flag taken = ATOMIC_FLAG_INIT;
  };
  void add(std::size_t row, const std::int32_t* ids, std::size_t n, std::int32_t* multiplicity);
  static Entry& slot(Row& row, std::int32_t id);
  /// The entry of the same pair in the other order, or nullptr.
  const Entry* mirrored(std::size_t i, std::int32_t j) const;
  void update_spreads();
  bool sampled(std::size_t i, std::size_t j) const;
  static void grow(Row& row);
  std::size_t thin(std::size_t row, std::uint64_t seed);  ///< returns what is left

  std::vector<char> kind_;
  std::vector<Row> rows_;
  std::unique_ptr<Lock[]> locks_;
  std::size_t max_entries_, entries_ = 0;
  int replicates_ = 0, unit_ = 1;
};

}  // namespace granrad
