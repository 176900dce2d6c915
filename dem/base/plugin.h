#pragma once
#include <filesystem>
#include <string>

namespace granrad {

/// Where a part built apart from the programs lies (NAME.so), so that only those who ask for it load what it needs:
/// lib/granrad beside the folder of this program or library. Empty: it is not installed.
std::filesystem::path plugin_file(const std::string& name);

/// A function of such a part, which is loaded at the first call and stays. Throws InputError with the linker's words
/// where it cannot be loaded or lacks the function.
void* plugin_function(const std::filesystem::path& file, const char* function);

}  // namespace granrad
