#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Reads an STL file, text or binary, as mesh walls: one per solid, named `name` when there is one and
/// `name.SOLID` when there are several. Vertices are multiplied by `scale` (0.001 for a file in millimetres)
/// and equal ones merged; text keeps double precision (100 m from the origin single precision is 8 um). The order of a triangle's vertices (right-hand rule) tells its normal side; normals
/// in the file are ignored. Throws IoError when the file cannot be read, InputError when it is not STL or has
/// triangles without area or vertices that are not finite.
std::vector<Wall> import_stl(const std::filesystem::path& file, double scale, const std::string& name);

}  // namespace granrad
