#pragma once
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Faces whose normals have a smaller cosine are not looked at further: heights of corners decide about the rest.
inline constexpr double nearly_parallel = 0.999;

struct LaidPlates {
  /// By wall: whether it faces out of the plane it lies in and another plate, facing away, rises along each of its edges.
  /// On it a body of plates stands: neither it nor what it lies on meets a particle.
  std::vector<char> is_foot;
  std::vector<std::string> notes;  ///< of plates that were turned
};

/// Moves plates into the plane of an earlier plate they all but lie in (within slack_m). One that faces out of the outermost
/// plane, where there is nothing to see, and is no foot is turned: whoever draws a patch on a wall need not think of its
/// winding. `by_age`: the walls, the earliest first.
LaidPlates lay_plates(std::vector<Wall>& walls, const std::vector<std::size_t>& by_age, double slack_m);

}  // namespace granrad
