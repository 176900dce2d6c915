#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace granrad {

/// Three vertex numbers, right-handed about the normal.
using Triangle = std::array<std::int32_t, 3>;

/// Turns triangles so that neighbours face the same side: two that alone share an edge run along it in opposite
/// directions. Meshes are taken together, vertex numbers being common to them. In each connected part the side of the
/// most triangles is kept; parts that have no two sides (a Moebius strip) stay as they are. Edges of more than two
/// triangles (sheets of two sides, seams of bodies) tell nothing. Returns how many were turned.
std::size_t wind_alike(std::vector<std::vector<Triangle>>& meshes);

}  // namespace granrad
