#pragma once
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// One planar convex face of a wall: its polygon, or one triangle of its mesh.
struct WallFace {
  std::vector<Vec3> vertices;
  Vec3 normal;  ///< unit, right-handed
  Box bounds;
};

std::vector<WallFace> faces_of(const Wall& wall);

/// Distance from p to the nearest point of the face: of its interior, an edge or a corner. From both sides.
double distance_to(const WallFace& face, const Vec3& p);

/// Distance from p to the nearest point of the wall.
double distance_to(const Wall& wall, const Vec3& p);

}  // namespace granrad
