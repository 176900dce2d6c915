#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raytrace/exchange.h"
#include "raytrace/rays/hit_tally.h"
#include "raytrace/rays/variance_table.h"

namespace granrad {

/// What one surface's rays found.
struct TracedRow {
  std::vector<HitEntry> entries;
  std::int64_t launched = 0, leaked = 0, chords = 0;
  double chord_sum_m = 0, chord_square_sum_m2 = 0;
  /// Where replicates are kept apart: hits on each surface in each.
  struct Part {
    std::int32_t replicate, surface, hits;
  };
  std::vector<Part> parts;
  HitEntry stated;  ///< the walls whose error is stated, as if they were one

  void add_chords(const TracedRow& more) {
    leaked += more.leaked;
    chords += more.chords;
    chord_sum_m += more.chord_sum_m;
    chord_square_sum_m2 += more.chord_square_sum_m2;
  }
};

/// Gives the other ranks the rows at the places that this one traced, and takes theirs.
void share_rows(std::vector<TracedRow>& rows, const std::vector<std::size_t>& mine);

/// Drops rare pairs at random so that the rest stands for them.
class Thinning {
 public:
  Thinning(std::uint64_t seed, std::int64_t unit) : seed_(seed ^ 0x7468696eull), unit_(unit) {}
  std::int64_t unit() const { return unit_; }

  std::int64_t kept(std::int32_t i, std::int32_t j, std::int64_t hits) const;

 private:
  std::uint64_t seed_;
  std::int64_t unit_;
};

/// Whether the pairs could fill the memory if every ray met another surface. Throws InputError when even a
/// few for each surface would.
bool pairs_may_outgrow(const std::vector<std::int64_t>& rays, std::size_t limit_bytes);
/// Smallest power of two that keeps the pairs of all surfaces, judged by a sample of rows, within memory.
std::int64_t thinning_unit(const std::vector<TracedRow>& sample, std::size_t surfaces,
                           std::size_t limit_bytes);

/// Gathers rows in the order of the surfaces.
class CountBuilder {
 public:
  CountBuilder(HitCounts& counts, Thinning thinning, int replicates, int of_walls, double stated_density);
  void append(const TracedRow& row);
  void finish();

 private:
  void add_pair_of_walls(std::int32_t i, const HitEntry& e, std::int64_t launched);

  HitCounts& counts_;
  Thinning thinning_;
  int replicates_, of_walls_;
  std::size_t walls_;  ///< surroundings among them
  double stated_density_;
  std::array<VarianceTable, 4> table_;
  SumVariance sum_;
  double area_ = 0, chord_ = 0, chord_variance_ = 0;
};

}  // namespace granrad
