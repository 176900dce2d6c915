#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/bed/bed.h"
#include "dem/bed/wall_surface.h"

namespace granrad {

/// Two particles whose surfaces are closer than the gap asked for. i < j.
struct NearPair {
  std::int32_t i, j;
  double distance_m;  ///< between the centres (nearest periodic image)
};

/// A particle and a place of a wall where the distance from the centre has a local minimum (inside a face, on
/// an edge, at a corner; see wall_surface.h): the places where forces act are those where heat passes. A
/// sphere in an edge of a mesh is near two of its faces, one over the seam of two walls near one of them.
struct NearWall {
  std::int32_t i;
  std::int32_t wall;  ///< index into Bed::walls
  double distance_m;
  /// Part of a whole gas lens that fits beside those of the nearer places: 1 - cos of the angle between the
  /// faces, at most 1. Faces at right angles have whole lenses, flat ones share one.
  double gas_share = 1;
};

struct NearPairs {
  std::vector<NearPair> particles;  ///< sorted by (i, j)
  std::vector<NearWall> walls;      ///< sorted by (i, wall, distance)
};

/// All pairs with surface gap (distance - r_i - r_j, or distance - r_i) <= max_gap_m, by a cell list.
/// Walls without contact and shutters that are open at bed.time_s are left out. Cost O(N) for similar radii.
///
/// Of several parts, what this one finds: each pair is found by one of them, all walls of a particle by the same; parts are
/// regions of the bed with as many particles each.
NearPairs near_pairs(const Bed& bed, double max_gap_m, int part = 0, int parts = 1);

/// Its walls alone; `surface` is that of the bed's walls, at its time. `among`: the particles to look at, each once; null: all.
std::vector<NearWall> near_walls(const Bed& bed, const WallSurface& surface, double max_gap_m,
                                 const std::vector<std::int32_t>* among = nullptr);

/// The near walls of particle i at p among the standing facets from `begin` to `end`, in ascending order.
void append_near_walls(const WallSurface& surface, std::int32_t i, const Vec3& p, double radius_m,
                       double max_gap_m, const std::int32_t* begin, const std::int32_t* end,
                       std::vector<NearWall>& out);

/// Pairs (anything with i and j) found in any order by several searchers, sorted by (i, j); `particles` is how many there
/// are. Counting by i, then each row.
template <class Pair>
std::vector<Pair> sorted_by_rows(const std::vector<std::vector<Pair>>& parts, std::size_t particles) {
  std::vector<std::size_t> begin(particles + 1, 0);
  for (const auto& part : parts)
    for (const auto& pair : part) ++begin[pair.i + 1];
  for (std::size_t i = 0; i < particles; ++i) begin[i + 1] += begin[i];
  std::vector<Pair> sorted(begin[particles]);
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const auto& part : parts)
    for (const auto& pair : part) sorted[next[pair.i]++] = pair;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < particles; ++i)
    std::sort(sorted.begin() + begin[i], sorted.begin() + begin[i + 1],
              [](const Pair& a, const Pair& b) { return a.j < b.j; });
  return sorted;
}

/// Sorts by (i, wall, distance).
void sort_by_rows(std::vector<NearWall>& walls);

}  // namespace granrad
