#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad::liggghts {

/// Triangles of all walls with one surface velocity.
struct WallMesh {
  Vec3 velocity_m_s;
  std::vector<std::array<Vec3, 3>> triangles;
  bool operator==(const WallMesh&) const = default;
};

/// The walls of a Bed that stand at its time as triangles, cut off at the periodic sides of the box: LIGGGHTS
/// repeats them there. Every face of every wall has a number, in the order of walls and triangles, whether it
/// stands or not; a polygon is one face and becomes a fan of triangles.
class WallMeshes {
 public:
  explicit WallMeshes(const Bed& bed);

  const std::vector<WallMesh>& meshes() const { return meshes_; }
  std::int64_t face_of(std::size_t mesh, std::int32_t triangle) const { return face_[mesh][triangle]; }

  struct Place {
    std::size_t mesh;
    std::int32_t triangle;
  };
  /// The triangle of a face that is nearest to p (the first of equals); triangle -1 where the face does not
  /// stand or has no such number.
  Place nearest(std::int64_t face, const Vec3& p) const;

 private:
  void add(const Wall& wall, const std::vector<Vec3>& corners, std::int64_t face);
  std::vector<WallMesh> meshes_;
  std::vector<std::vector<std::int64_t>> face_;  ///< by mesh and triangle
  std::vector<Place> first_;                     ///< by face
};

}  // namespace granrad::liggghts
