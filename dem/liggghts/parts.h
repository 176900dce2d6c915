#pragma once
#include <array>
#include <vector>

#include "dem/base/vec3.h"
#include "dem/bed/box.h"

namespace granrad::liggghts {

/// How the domain is cut for the ranks: count[a] slabs along axis a, every rank has one of their crossings.
struct Parts {
  std::array<int, 3> count{1, 1, 1};
  std::array<std::vector<double>, 3> split;  ///< where slabs begin and end, in parts of the domain: 0 ... 1
  bool operator==(const Parts&) const = default;
};

/// Parts of `domain` for as many ranks, around these places (outside it: at its side): as little surface between them as
/// their extent allows, and along each axis about as many places in one slab as in another. A function of the places that
/// changes in steps of a sixteenth of a slab, so that it seldom changes as they move.
Parts parts_of(const Box& domain, const std::vector<Vec3>& places, int ranks);

}  // namespace granrad::liggghts
