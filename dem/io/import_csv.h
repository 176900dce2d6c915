#pragma once
#include "dem/io/snapshot.h"

namespace granrad {

/// Reads particles from comma-separated text whose first line names the columns (see ParticleTable), in any
/// order; blank lines and lines that start with # are skipped. Throws IoError, InputError (all bad lines,
/// first twenty).
Snapshot import_csv(const std::filesystem::path& file, double radius_m = 0);

}  // namespace granrad
