#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/bed/bed.h"
#include "dem/liggghts/parts.h"
#include "dem/liggghts/wall_meshes.h"

namespace granrad::liggghts {

/// Everything of a LIGGGHTS run but its particles. A material that particles are made of is an atom type;
/// where they are several, walls are one more.
struct Deck {
  std::vector<std::int32_t> type_of_material;            ///< from 1; 0: no particle is made of it
  std::vector<std::string> before_meshes, after_meshes;  ///< commands
  std::vector<WallMesh> meshes;
  std::int32_t mesh_type = 1;
  Parts parts;  ///< of the ranks

  bool operator==(const Deck&) const = default;
};

/// The name of a mesh in the commands.
std::string mesh_name(std::size_t number);

/// The deck of this Bed with the walls that stand, for so many ranks. A wall is of each particle's own material (dem/native/
/// materials.h), which LIGGGHTS can do for restitution and friction only.
/// Precondition: where there are walls all materials have one Young's modulus and one Poisson ratio.
Deck make_deck(const Bed& bed, const WallMeshes& walls, const Vec3& gravity_m_s2, double step_s, int ranks);

}  // namespace granrad::liggghts
