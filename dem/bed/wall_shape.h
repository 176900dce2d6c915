#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// One planar convex face of a wall.
struct WallFace {
  std::vector<Vec3> vertices;
  Vec3 normal;  ///< unit, right-handed
  Box bounds;
};

/// The faces of a wall in a fixed order: its polygon, or its triangles. Triangles without area are among
/// them (their normal is not a number).
std::vector<WallFace> faces_of(const Wall& wall);
std::size_t face_count(const Wall& wall);
/// A face of the corners given, in their order.
WallFace make_face(std::vector<Vec3> vertices);
/// Replaces the shape of a wall. One face stays a polygon; several become triangles.
void set_faces(Wall& wall, const std::vector<WallFace>& faces);
/// All faces turned: they radiate to the other side.
void flip(Wall& wall);

/// Half the norm of the sum of cross products of the edges from the first corner, m^2: the area of a planar
/// polygon (and of its projection on its mean plane when it is not planar).
double polygon_area(const std::vector<Vec3>& vertices);
/// Unit normal of a polygon (Newell's method).
Vec3 polygon_normal(const std::vector<Vec3>& vertices);
/// Triangles that tile a convex polygon, whose corners may lie on the line between their neighbours; none is
/// without area. The fan of the first corner where that will do.
std::vector<std::array<Vec3, 3>> triangulated(const std::vector<Vec3>& vertices);

/// Sum of the areas of the faces, m^2.
double area(const Wall& wall);
Box bounds_of(const Wall& wall);

/// The plane all faces lie in, facing one way.
struct WallPlane {
  Vec3 point, normal;
  double height(const Vec3& p) const { return dot(normal, p - point); }
};
/// Empty for a wall that is bent, or that faces both ways.
std::optional<WallPlane> plane_of(const Wall& wall);

/// The parallelogram of a wall that is one: a corner and its two sides, (corner + u side[0] + v side[1]).
struct Parallelogram {
  Vec3 corner, side[2];
};
std::optional<Parallelogram> parallelogram_of(const Wall& wall);
/// Triangles to draw points of the wall from: of its faces, each a fan about its first corner.
std::vector<std::array<Vec3, 3>> triangles_of(const Wall& wall);

/// Distance from p to the nearest point of the face: of its interior, an edge or a corner. From both sides.
double distance_to(const WallFace& face, const Vec3& p);
/// Distance from p to the nearest point of the wall.
double distance_to(const Wall& wall, const Vec3& p);

}  // namespace granrad
