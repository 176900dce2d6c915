#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
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
  StateBlocks state;
  std::string origin;                   ///< file it came from
  bool has_temperature = true;          ///< false: the file had none, temperature_K is a placeholder of 300 K
  std::vector<std::size_t> file_row{};  ///< row of each particle in the file; empty: rows in order
};

/// Writes one frame: VTKHDF 1.0 UnstructuredGrid (points as vertices; PointData id, radius, temperature,
/// velocity, angular_velocity, q_rad and `extra` columns) plus /granrad with the full state, exact to the
/// bit. Written to a temporary name, fsynced, renamed: a frame is whole or not there. Throws IoError.
void write_frame(const std::filesystem::path& file, const Bed& bed, const StateBlocks& state,
                 const std::map<std::string, std::vector<double>>& extra = {});

/// Writes `name.hdf.series`, by which ParaView shows frames at their times: (file, time in s), file names
/// relative to the folder of `series_file`. Written whole or not at all. Throws IoError.
void write_series(const std::filesystem::path& series_file,
                  const std::vector<std::pair<std::filesystem::path, double>>& frames);

/// Reads a frame written by write_frame, bit for bit. Throws IoError (cannot read) or InputError (not a
/// frame).
Snapshot read_frame(const std::filesystem::path& file);

/// Reads a snapshot of any supported kind by extension and content: .hdf frame, .csv
/// (x,y,z,radius[,temperature,vx,vy,vz,omegax,omegay,omegaz], SI), LIGGGHTS/LAMMPS text dump (columns by
/// header name; the last snapshot of the file). `radius_m` > 0 serves files without a radius column. Radii,
/// positions must be finite, radii positive, else InputError with line numbers, every line at once (first
/// 20).
Snapshot read_snapshot(const std::filesystem::path& file, double radius_m = 0);

}  // namespace granrad
