#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "dem/packing/packing.h"

namespace granrad {

/// Largest displacement of a trial move in each direction, m. Longest: at most half the box.
struct MoveLength {
  Vec3 shortest, longest;
};

/// Metropolis moves (J. Chem. Phys. 21 (1953) 1087) of hard spheres: each sweep
/// offers every sphere one random displacement, taken when it
/// neither overlaps another sphere nor a wall. Detailed balance holds at a fixed step length, so the
/// stationary state is the hard-sphere fluid. The length of moves grows from the shortest to the
/// longest, as long as 40 % are accepted, during the first half of the sweeps only.
/// `may_be_at`, if given, keeps spheres out of a place: a sphere that stands where it returns false, or that
/// would move there, stays. Random numbers are those of (seed, stream), so a new stream gives new moves.
void shake_spheres(const PackingBox& where, const std::vector<double>& radius_m, std::vector<Vec3>& position,
                   const MoveLength& length, int sweeps, std::uint64_t seed, std::uint64_t stream,
                   const std::function<bool(const Vec3&)>& may_be_at = {});

}  // namespace granrad
