#pragma once
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// A mesh as it stands in a file: three corners a triangle.
struct Facets {
  std::string name;
  std::vector<Vec3> corners;
};

/// What was mended of the meshes of a file.
struct MeshMending {
  double tolerance_m = 0;
  std::size_t welded = 0;    ///< corners moved onto another that was not equal
  std::size_t flat = 0;      ///< triangles without area, dropped
  std::size_t doubled = 0;   ///< triangles given before with the same side, dropped
  std::size_t split = 0;     ///< triangles cut where a corner of others lies on their edge
  std::size_t turned = 0;    ///< triangles that faced the other side than their neighbours (winding.h)
  std::string note() const;  ///< "" when nothing was
};

/// Corners closer than this part of the size of all meshes (the diagonal of their box) are one: programs write
/// the same corner with different last digits.
inline constexpr double weld_tolerance = 1e-5;

/// Walls of the meshes, in metres: equal corners are one vertex in all of them, triangles without area and
/// triangles given twice in one mesh are left out, and a triangle with a vertex of others on its edge is cut
/// there, so that edges meet edges. The order of a triangle's corners is kept but where its neighbours face the other
/// side. Meshes that keep no triangle give no wall. Throws InputError when a corner is not finite.
std::vector<Wall> mended(const std::vector<Facets>& meshes, double scale, const std::string& file,
                         MeshMending& mending);

}  // namespace granrad
