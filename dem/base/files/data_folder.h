#pragma once
#include <filesystem>
#include <string>

namespace granrad {

/// Where materials, correlations and example scenes are: $GRANRAD_DATA; share/granrad beside the folder of the running
/// program or below the prefix of the installation; `data` of the source tree the build came from. Empty if none exists.
std::filesystem::path data_folder();

/// A file named in a scene among the installed data: "alumina.toml" or "materials/alumina.toml" below data_folder(),
/// in it or in one of its folders of the first level. Empty when there is none, or for names that leave the folder.
std::filesystem::path installed_file(const std::filesystem::path& name);

}  // namespace granrad
