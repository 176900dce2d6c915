#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// What cover_walls did, for those who wrote the walls.
struct WallCover {
  std::vector<std::string> notes;  ///< one for every two walls: what covers what, m^2
  std::vector<std::size_t> kept;   ///< where each wall left stood before
};

/// Makes walls that lie in one place one surface.
///
/// A face that lies in the plane of an earlier one and faces alike covers it: what it covers is cut out of
/// the earlier face, for radiation, gas and contact alike. So a wall is given a heated patch or zones, a
/// vessel is set into a box of its size, and a facet given twice counts once. Where a body stands on a wall
/// (they face each other there, and all of the body is on the wall's front side) both are cut: neither meets
/// a particle. Plates of two sides, whose faces lie back to back, stay. Walls that are covered altogether are
/// dropped.
///
/// Corners of cut faces that lie on edges of other faces become corners of those too, so that walls which
/// meet share their edges and act as one plane.
///
/// A plate that all but lies in the plane of an earlier one is moved into it. Where that plane has all walls on its
/// front side and the plate faces out, it is turned (a note says so): behind it there is nothing to heat.
///
/// Places closer than 2e-7 of the extent of all walls are one: the rounding of STL files in single precision.
/// `order`: which of two walls is later (its line in the scene); none: their order.
///
/// Throws InputError that names both walls when one lies on another but particles touch only one of them, or
/// they open at different times: then there is no one surface.
WallCover cover_walls(std::vector<Wall>& walls, const std::vector<std::int64_t>& order = {});

}  // namespace granrad
