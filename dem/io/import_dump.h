#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/base/files/text_lines.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// A LIGGGHTS or LAMMPS text dump, of any number of snapshots: columns by the names of the ITEM: ATOMS line
/// (ColumnNames); x y z, unwrapped xu yu zu, or scaled xs ys zs with the box bounds. Gives particles, box,
/// periodic directions, step, and the time when the dump has ITEM: TIME. Walls and materials are not in a dump.
class DumpFile {
 public:
  /// Finds the snapshots without reading their rows. A last snapshot that ends with the file (of a simulation
  /// that still runs) is left out, if there is one before it, and `note` says so. Throws IoError, InputError
  /// (no snapshot, a snapshot cut short, a line that is none of a dump).
  DumpFile(const std::filesystem::path& file, std::string text, double radius_m);

  const std::vector<std::int64_t>& steps() const { return steps_; }
  const std::string& note() const { return note_; }
  /// Snapshot number k. Throws InputError with all bad lines (the first twenty).
  Snapshot read(std::size_t k) const;

 private:
  struct Header;
  class Reader;
  std::string file_;
  TextLines lines_;
  double radius_m_;
  std::vector<std::int64_t> steps_;
  std::vector<TextLines::Place> begins_;  ///< of each snapshot's first ITEM
  std::string note_;
};

}  // namespace granrad
