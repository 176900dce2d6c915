#pragma once
#include "dem/base/files/text_lines.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// Reads particles from comma-separated text whose first line names the columns (ColumnNames), in any order;
/// blank lines and lines that start with # are skipped. Throws InputError (all bad lines, first twenty).
Snapshot import_csv(const std::string& file, TextLines lines, double radius_m);

}  // namespace granrad
