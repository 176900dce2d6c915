#pragma once
#include <filesystem>

#include "coupling/granrun/run_options.h"

namespace granrad {

/// Writes DIR/report.html of a finished or running case: results, histories, and profiles from its latest
/// frames. Throws InputError (not a case), IoError.
int report_case(const std::filesystem::path& folder, const RunOptions& options);

}  // namespace granrad
