#pragma once
#include <array>
#include <cstdint>

#include "raytrace/facets.h"
#include "raytrace/shading/beam_lines.h"

namespace granrad {

/// A pair's lines as they lie in the enclosure.
struct Beam {
  const BeamLines::Set& lines;
  Vec3 axes[3];   ///< the last along the pair
  Vec3 centre_m;  ///< of the first sphere
  double diameter_m;
  double distance;  ///< of the centres, in diameters

  Vec3 turned(float x, float y, float z) const { return x * axes[0] + y * axes[1] + z * axes[2]; }
  Vec3 point_m(std::size_t k) const {
    return centre_m + diameter_m * turned(lines.point_x[k], lines.point_y[k], lines.point_z[k]);
  }
  Vec3 direction(std::size_t k) const {
    return normalized(turned(lines.direction_x[k], lines.direction_y[k], lines.direction_z[k]));
  }
};

/// The planes of a convex room that both ends of each line of a pair lie on.
class BeamEnds {
 public:
  void find(const Beam& beam, const ConvexCell& room);

  std::int32_t ahead(std::size_t line) const { return ahead_[line]; }    ///< beyond the second sphere
  std::int32_t behind(std::size_t line) const { return behind_[line]; }  ///< beyond the first one

 private:
  /// Plane `number`: unit normal along the axes of the beam, height of the first centre in diameters.
  void meet(const BeamLines::Set& lines, std::int32_t number, float nx, float ny, float nz, float height);

  std::array<float, BeamLines::most> ahead_at_, behind_at_;
  std::array<std::int32_t, BeamLines::most> ahead_, behind_;
};

}  // namespace granrad
