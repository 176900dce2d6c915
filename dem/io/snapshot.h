#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// State of a room that a restart needs beside the Bed (feed, ledger, radiation update number ...): named
/// columns, written under /granrad/state/<block>/<name>.
struct StateBlock {
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::map<std::string, std::vector<double>> reals;
};
using StateBlocks = std::map<std::string, StateBlock>;

/// A Bed with its origin.
struct Snapshot {
  Bed bed;
  StateBlocks state{};
  std::string origin{};                 ///< file it came from
  bool has_temperature = true;          ///< false: the file had none, temperature_K is a placeholder of 300 K
  bool has_radius = true;               ///< false: the radius given serves all particles
  bool has_types = false;               ///< material is the type of a dump, less one
  std::vector<std::size_t> file_row{};  ///< row of each particle in the file; empty: rows in order
  std::string note{};                   ///< what a user should know about how it was read, or ""
};

/// Writes one frame: VTKHDF 1.0 UnstructuredGrid (points as vertices; PointData: the columns of the Bed and
/// `extra` columns) plus /granrad with the full state, exact to the bit. Written to a temporary name, fsynced,
/// renamed: a frame is whole or not there. Throws IoError, NumericalError (a state that is not finite).
void write_frame(const std::filesystem::path& file, const Bed& bed, const StateBlocks& state,
                 const std::map<std::string, std::vector<double>>& extra = {});

/// Writes `name.hdf.series`, by which ParaView shows frames at their times: (file, time in s), file names
/// relative to the folder of `series_file`. Written whole or not at all. Throws IoError.
void write_series(const std::filesystem::path& series_file,
                  const std::vector<std::pair<std::filesystem::path, double>>& frames);

/// Reads a frame written by write_frame, bit for bit. Throws IoError (cannot be read, damaged) or InputError
/// (not a frame, or of a newer program).
Snapshot read_frame(const std::filesystem::path& file);

/// Which snapshot of a file.
struct SnapshotChoice {
  enum class Kind { last, first, step } kind = Kind::last;
  std::int64_t step = 0;
};

/// A file of one or more snapshots, of any kind, told by its content: our frames; CSV with a header; LIGGGHTS
/// and LAMMPS text dumps; XYZ and extended XYZ; VTK, legacy and XML (.vtp, .vtu); all but frames also packed by
/// gzip. docs/formats.md says what each may hold.
class SnapshotFile {
 public:
  /// `radius_m` > 0 serves files without radii (Snapshot::has_radius). Throws IoError,
  /// InputError (of no kind that is read: the message lists those that are).
  explicit SnapshotFile(const std::filesystem::path& file, double radius_m = 0);
  ~SnapshotFile();
  SnapshotFile(const SnapshotFile&) = delete;
  SnapshotFile& operator=(const SnapshotFile&) = delete;

  const std::vector<std::int64_t>& steps() const;  ///< of each snapshot, in the order of the file
  /// Place of the snapshot chosen. Throws InputError, naming the steps there are.
  std::size_t find(const SnapshotChoice& choice) const;
  /// Radii and positions are finite, radii positive. Throws InputError with every bad line (the first twenty).
  Snapshot read(std::size_t k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The snapshot of `file` that is chosen; throws as SnapshotFile.
Snapshot read_snapshot(const std::filesystem::path& file, double radius_m = 0,
                       const SnapshotChoice& choice = {});

}  // namespace granrad
