#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/rays/hit_tally.h"

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

}  // namespace granrad
