#pragma once
#include <filesystem>
#include <string>

namespace granrad {

/// granrun new: copies the example scene `example` ("demo", "plug_phi025") of the installed data to `file`, and every
/// file it names beside it, with the names changed accordingly. An unknown name is an InputError that lists the
/// examples; so is a file that is there already.
int new_scene(const std::filesystem::path& file, const std::string& example);

}  // namespace granrad
