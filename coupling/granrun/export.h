#pragma once
#include <filesystem>
#include <string>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// Writes every frame of a case into DIR/export: `vtp` VTK PolyData (ASCII XML), `dump` LAMMPS text dump with
/// columns id type x y z radius vx vy vz omegax omegay omegaz temperature q_rad. SI. Throws InputError,
/// IoError.
int export_case(const std::filesystem::path& folder, const std::string& format, const RunOptions& options);

}  // namespace granrad
