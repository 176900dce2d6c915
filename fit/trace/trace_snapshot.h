#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dem/io/snapshot.h"
#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

enum class TraceMethod { embree, lines };
const char* to_string(TraceMethod method);

/// What `vfgen trace` is asked for.
struct TraceSettings {
  TraceMethod method = TraceMethod::embree;
  double rays = 10000;                  ///< per particle; walls in proportion to area
  double error = 0;                     ///< > 0: instead of rays, the stated error wanted (stated_error.h)
  std::vector<std::string> hot_walls;   ///< whose particle fluxes the stated error is of; none: wall sums
  Sampling sampling = Sampling::sobol;  ///< embree only
  std::size_t memory_limit_bytes = std::size_t{4} << 30;
  std::optional<double> emissivity;       ///< grey particles: total exchange areas; embree only
  std::optional<double> wall_emissivity;  ///< default: each wall's own
  std::uint64_t seed = 1;
  int threads = 0;
  TraceWatch watch;  ///< progress of the present round, and whether to go on
};

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

/// Throws InputError, with every problem, for settings that do not go together, walls that are not there, or
/// nothing to trace. `snapshot` names the enclosure in messages.
void require_traceable(const Enclosure& enclosure, const TraceSettings& settings,
                       const std::string& snapshot);

/// Traces, closes (reciprocal) and checks; the caller decides what a failed check means. Throws what
/// require_traceable throws, TraceStopped.
ViewFactorFile trace(const Enclosure& enclosure, const TraceSettings& settings, const std::string& origin);

/// "spent 1.2e+07 rays in 3 rounds, 4.1 s; error 0.96 % of the particle-wall sums (1 % asked for)".
std::string spent_line(const ViewFactorFile& traced);

/// "closure 1.2e-16, reciprocity chi2 1.01, mean chord 1.0002, leaked 0".
std::string self_check_line(const SelfCheck& check);

}  // namespace granrad
