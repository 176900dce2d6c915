#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/base/vec3.h"
#include "dem/liggghts/wall_meshes.h"

namespace granrad::liggghts {

/// A tangential spring of a sphere, seen by it.
struct Spring {
  std::int32_t sphere;   ///< index
  std::int32_t partner;  ///< index of the other sphere, or of a triangle in its mesh (its id there)
  Vec3 displacement_m;
};

/// All that LIGGGHTS moves. Columns have equal length; an index means the same before and after a run.
struct Spheres {
  std::vector<Vec3> position_m, velocity_m_s, angular_velocity_rad_s;
  std::vector<double> radius_m, density_kg_m3;
  std::vector<std::int32_t> type;                 ///< from 1
  std::vector<Spring> pair_springs;               ///< each pair once, sphere < partner; sorted
  std::vector<std::vector<Spring>> wall_springs;  ///< by mesh; sorted
};

/// One silent instance of LIGGGHTS on this process. The only place with its headers and MPI's.
///
/// LIGGGHTS ends the process at an error; here its error functions are replaced by ones that throw, and
/// an instance that has thrown is abandoned.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// One line of a deck. Throws InputError.
  void command(const std::string& line);
  /// A mesh of this atom type; its number in Spheres::wall_springs is how many came before it.
  void add_mesh(const std::string& name, const WallMesh& mesh, std::int32_t type);
  /// Puts these spheres in place of those it has, moves them by `steps`, and reads them back (positions
  /// unwrapped from where they were). Throws NumericalError.
  void run(Spheres& spheres, std::int64_t steps);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad::liggghts
