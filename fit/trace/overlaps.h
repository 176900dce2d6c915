#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// Pairs of particles that overlap beyond what a packing can: more than half the smaller radius, or in the
/// same place.
struct Overlaps {
  using OverlappingPair = std::pair<std::int32_t, std::int32_t>;  ///< rows of the Bed, ascending
  struct Found {
    std::vector<OverlappingPair> first;  ///< the first ten
    std::int64_t count = 0;
  };
  Found deep, same_place;  ///< those in the same place are not counted as deep
  bool all = true;         ///< false: a million were found and the search ended
};

/// Among `particles`, rows of the Bed; nearest periodic images.
Overlaps find_overlaps(const Bed& bed, const std::vector<std::int32_t>& particles);

/// "12 pairs of particles, ids 1-7, 3-9, ..." by the ids of the Bed.
std::string describe(const Bed& bed, const Overlaps::Found& found, bool all);

}  // namespace granrad
