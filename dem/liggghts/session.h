#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "dem/liggghts/parts.h"
#include "dem/liggghts/spheres.h"
#include "dem/liggghts/wall_meshes.h"

namespace granrad::liggghts {

/// One silent instance of LIGGGHTS on this process, or this rank's share of one.
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
  /// Where the ranks' parts of the domain meet, once it is there and has that many; else they are equal.
  void cut(const Parts& parts);
  /// A mesh of this atom type; its number in Spring::mesh is how many came before it.
  void add_mesh(const std::string& name, const WallMesh& mesh, std::int32_t type);
  /// Puts these spheres in place of those it has, moves them by `steps`, and reads them back (positions
  /// unwrapped from where they were). Throws NumericalError.
  void run(Spheres& spheres, std::int64_t steps);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad::liggghts
