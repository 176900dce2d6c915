#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// Opens the log of a case, which also locks the case: -1 when another process works at it. Throws IoError.
int open_case_log(const std::filesystem::path& log);

/// Starts a program that writes to `log` (and holds its lock to its end), in a process group of its own, and
/// with SIGTERM when this process ends: a killed study leaves no stray cases, they save and stop. Closes `log`.
/// Throws IoError.
pid_t start_child(const std::vector<std::string>& words, int log);

/// The exit code of a child that has ended, 128 + signal when killed; -1 while it runs.
int child_exit_code(pid_t child);

}  // namespace granrad
