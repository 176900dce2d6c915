#pragma once
#include <filesystem>
#include <string>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// Writes every frame of a case into DIR/export, as `vtp`, `dump`, `csv` (export_text.h) or `npz` (numpy.load:
/// every column by its name with unit, time_s, step, box_m [2, 3], periodic [3]). Throws InputError, IoError.
int export_case(const std::filesystem::path& folder, const std::string& format, const RunOptions& options);

}  // namespace granrad
