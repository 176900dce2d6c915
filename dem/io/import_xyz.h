#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/base/files/text_lines.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// An XYZ file of any number of snapshots: a line with the number of particles, a line of keys, the rows.
/// Extended XYZ (OVITO, ASE): Properties= names the columns (pos, radius, velo, ...), Lattice= an upright box
/// with its corner at Origin=, pbc= its periodic directions, Time= or Timestep=. Without Properties a row is
/// `element x y z`. SI.
class XyzFile {
 public:
  /// Finds the snapshots; as with dumps a last one that ends with the file is left out and `note` says so.
  /// Throws InputError.
  XyzFile(std::string file, TextLines lines, double radius_m);
  const std::vector<std::int64_t>& steps() const { return steps_; }
  const std::string& note() const { return note_; }
  Snapshot read(std::size_t k) const;  ///< throws InputError with all bad lines (the first twenty)

 private:
  std::string file_;
  TextLines lines_;
  double radius_m_;
  std::vector<std::int64_t> steps_;
  std::vector<TextLines::Place> begins_;
  std::string note_;
};

}  // namespace granrad
