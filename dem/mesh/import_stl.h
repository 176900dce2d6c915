#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Reads an STL file, text or binary (or either packed by gzip), as mesh walls: one per solid, named `name` when
/// there is one and `name.SOLID` when there are several, SOLID being all that stands behind the word; names are
/// made to differ. Vertices are multiplied by `scale` (0.001 for a file in millimetres). Meshes are mended
/// (mesh_mend.h); `note` says what was. The order of a triangle's vertices (right-hand rule) tells its normal
/// side; normals in the file are ignored. Throws IoError when the file cannot be read, InputError when it is not
/// STL, has no triangle with an area or vertices that are not finite.
std::vector<Wall> import_stl(const std::filesystem::path& file, double scale, const std::string& name,
                             std::string* note = nullptr);

}  // namespace granrad
