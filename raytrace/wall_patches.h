#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dem/bed/wall_shape.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// Walls cut into patches, each a surface with a radiosity of its own: where light falls on a re-radiating wall is where
/// it leaves. Patches are numbered from 0 on, wall by wall. A polygon is cut into even strips of both directions; so are
/// the planar faces of a mesh of up to 1000 of them. Finer meshes (and walls not to be cut) are one patch.
class WallPatches {
 public:
  /// Cuts into patches no longer than `longest_m` along either side. `cut`: [walls]; empty: all.
  WallPatches(const std::vector<Wall>& walls, double longest_m, const std::vector<char>& cut = {});

  std::int32_t count() const { return static_cast<std::int32_t>(wall_.size()); }
  /// Index of the wall of a patch.
  std::int32_t wall(std::int32_t patch) const { return wall_[static_cast<std::size_t>(patch)]; }
  std::int32_t first(std::int32_t wall) const { return first_[static_cast<std::size_t>(wall)]; }
  bool is_cut(std::int32_t wall) const {
    const auto w = static_cast<std::size_t>(wall);
    return first_tile_[w + 1] > first_tile_[w];
  }
  /// Corners of a patch of a wall that is cut.
  const std::vector<Vec3>& corners(std::int32_t patch) const {
    return corners_[static_cast<std::size_t>(patch)];
  }
  /// Patch of a point of a wall met from the point `seen_from`, which tells the sides of a thin sheet apart; a point
  /// beyond the edge belongs to a patch at that edge.
  std::int32_t at(std::int32_t wall, const Vec3& point, const Vec3& seen_from) const;

  /// The enclosure with a wall for each patch in place of its walls.
  Enclosure applied_to(const Enclosure& whole) const;

 private:
  /// A cut: points with dot(normal, p) < offset lie on side 0. A child < 0 is the patch ~child.
  struct Cut {
    Vec3 normal;
    double offset;
    std::int32_t child[2];
  };
  struct Grid;
  /// A convex polygon of a wall: its first cut, or ~patch.
  struct Tile {
    WallFace face;
    std::int32_t root;
  };
  const Tile& tile_at(std::size_t wall, const Vec3& point, const Vec3& seen_from) const;
  std::int32_t divide(std::vector<Vec3> polygon, const Grid& grid, std::int32_t wall);

  std::vector<Cut> cuts_;
  std::vector<Tile> tiles_;
  std::vector<std::size_t> first_tile_;  ///< [walls + 1]
  std::vector<std::int32_t> first_, wall_;
  std::vector<std::vector<Vec3>> corners_;
};

/// How long patches of the walls in `cut` [walls] should be. Light on a wall varies over the free path between spheres, 4 V / S
/// in their bounding box: 0.22 of it, but half a diameter to two, keeps what one radiosity for each patch does to the heat of
/// each particle below 1 % rms (channel of 12 x 5 d, solid fractions 0.07 to 0.43, black; whole walls 2.2 to 6.8 %). Longer
/// where that would make more than 400 patches and two for each sphere.
double patch_length_m(const Enclosure& enclosure, const std::vector<char>& cut);

}  // namespace granrad
