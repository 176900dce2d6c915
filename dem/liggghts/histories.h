#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/liggghts/spheres.h"

namespace LAMMPS_NS {
class LAMMPS;
class Fix;
class FixContactHistory;
}  // namespace LAMMPS_NS

namespace granrad::liggghts {

/// The springs of this rank's atoms where LIGGGHTS keeps them: a history fix of pairs and one of each mesh.
class Histories {
 public:
  /// Of an instance that has made them, for meshes of these names. Throws InputError where they are not as expected.
  Histories(LAMMPS_NS::LAMMPS& lmp, const std::vector<std::string>& mesh_names);

  /// Gives springs to atoms that have none: atom_of[sphere], -1: of another rank. A pair's spring goes to both of its
  /// spheres, with opposite signs.
  void give(const std::vector<Spring>& springs, const std::vector<std::int32_t>& atom_of);
  /// Moves the springs of all atoms from the neighbour lists, where they are during a run, to where `append` finds them.
  void collect();
  /// Appends those of an atom in the order of Spheres::springs: at walls, then its pairs with spheres behind it.
  void append(int atom, std::int32_t sphere, std::vector<Spring>& out);

 private:
  struct OfMesh {
    LAMMPS_NS::FixContactHistory* history;
    LAMMPS_NS::Fix* neighbours;  ///< per sphere: for how many triangles the history has room
  };
  struct Given {
    std::int32_t mesh, partner;
    Vec3 displacement_m;
  };
  int& lists_are_newer();
  void give_atom(int atom, const Given* begin, const Given* end);
  int pack(LAMMPS_NS::FixContactHistory& fix, int atom);

  LAMMPS_NS::LAMMPS& lmp_;
  LAMMPS_NS::FixContactHistory* pairs_;
  std::vector<OfMesh> meshes_;
  std::vector<double>
      buffer_;  ///< springs of one atom as a fix packs them: count, then (partner, displacement) each
};

}  // namespace granrad::liggghts
