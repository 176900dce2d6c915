#pragma once
#include <string>

namespace granrad {

/// The root of the project's sources, where tests find data.
std::string source_dir();

}  // namespace granrad
