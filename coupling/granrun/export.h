#pragma once
#include <filesystem>
#include <string>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// Writes every frame of a case into DIR/export, as `vtp`, `dump` or `csv` (export_text.h). Throws InputError,
/// IoError.
int export_case(const std::filesystem::path& folder, const std::string& format, const RunOptions& options);

}  // namespace granrad
