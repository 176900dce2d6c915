#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// How the triangles of meshes fit together, all meshes taken as one surface; corners are the same when their
/// coordinates are.
struct MeshCheck {
  std::size_t triangles = 0;
  std::size_t open_edges = 0;    ///< of one triangle only: rays leave there, as `open`
  std::size_t turned_edges = 0;  ///< where two triangles face opposite sides: one of them shows its back
  double volume_m3 = 0;  ///< enclosed: > 0 when normals point inward; of closed meshes that face one way
};
MeshCheck check_meshes(const std::vector<Wall>& walls);

/// Whether a face of the wall lies on another of its own that looks the other way: a thin sheet seen from both sides.
bool has_two_sides(const Wall& wall);

/// "12 triangles, closed, normals inward", or what is wrong and what comes of it.
std::string describe(const MeshCheck& check);

}  // namespace granrad
