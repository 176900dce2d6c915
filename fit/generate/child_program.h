#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// The program `name` beside this one (an installation and a build keep them together), else as found on PATH.
std::string sibling_program(const std::string& name);

/// Runs a program to its end, its output added to `log`, and returns its exit code, or 128 + the number of the
/// signal that ended it. An interrupt reaches it as it reaches this one; it is killed when this one dies. Throws IoError when it cannot be
/// started.
int run_child(const std::string& program, const std::vector<std::string>& arguments,
              const std::filesystem::path& log);

}  // namespace granrad
