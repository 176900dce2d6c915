#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dem/io/snapshot.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// How a snapshot without walls becomes an enclosure.
struct EnclosureSettings {
  /// A mesh of walls; its lengths times `scale` are metres.
  struct Stl {
    std::filesystem::path file;
    double scale = 1;
  };
  double radius_m = 0;     ///< for files without a radius column
  SnapshotChoice which;    ///< of a file of several
  std::optional<Box> box;  ///< six black walls around
  std::vector<Stl> stl;
};

/// The surfaces of a snapshot.
struct SnapshotEnclosure {
  Enclosure enclosure;
  std::string note;          ///< how the file was read, where that is not plain (Snapshot::note)
  std::size_t left_out = 0;  ///< particles with their centre outside the box
  std::string
      meshes;  ///< what was mended of the STL, how its triangles fit together, what was done to the walls
  std::string overlaps;  ///< the pairs that overlap by more than half a radius; empty without any
};

/// "FILE" or "FILE:SCALE" (hopper.stl:0.001). Throws InputError.
EnclosureSettings::Stl parse_stl(const std::string& text);

/// "first", "last" or a number of a step. Throws InputError.
SnapshotChoice parse_step(const std::string& text);

/// "X,Y,Z" or "X,Y,Z:x0,y0,z0" in metres. Throws InputError.
Box parse_box(const std::string& text);

/// Reads a snapshot and gives it its walls: its own, those of `stl`, and the box. Throws InputError
/// (two particles in the same place among others), IoError.
SnapshotEnclosure read_enclosure(const std::filesystem::path& snapshot, const EnclosureSettings& settings);

}  // namespace granrad
