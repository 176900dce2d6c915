#pragma once
#include <string>
#include <string_view>

#include "dem/io/snapshot.h"

namespace granrad {

/// Reads the points of a legacy VTK file (LIGGGHTS' dump custom/vtk, ParaView): PolyData or UnstructuredGrid,
/// ASCII or BINARY, with its point data. Throws InputError.
Snapshot import_vtk_legacy(const std::string& file, std::string_view text, double radius_m);

/// Reads the points of a VTK XML file, .vtp or .vtu: arrays in ASCII, base64 or appended, packed by zlib or not.
/// Throws InputError.
Snapshot import_vtk_xml(const std::string& file, std::string_view text, double radius_m);

}  // namespace granrad
