#pragma once
#include "dem/io/snapshot.h"

namespace granrad {

/// Reads the last snapshot of a LIGGGHTS or LAMMPS text dump: columns by the names of its ITEM: ATOMS line
/// (see ParticleTable); x y z, unwrapped xu yu zu, or scaled xs ys zs with the box bounds. Gives particles,
/// box, periodic directions, step, and the time when the dump has ITEM: TIME. Walls and materials are not in
/// a dump. Throws IoError, InputError (all bad lines, first twenty; a snapshot cut short).
Snapshot import_dump(const std::filesystem::path& file, double radius_m = 0);

}  // namespace granrad
