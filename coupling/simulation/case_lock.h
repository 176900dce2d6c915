#pragma once
#include <filesystem>
#include <string>

namespace granrad {

/// A folder belongs to one process while this lives: an advisory lock on DIR/.lock, which the system gives back
/// when the process ends, however it ends. The file says who holds it: host and process number.
class CaseLock {
 public:
  /// Creates the folder where it is absent. Throws InputError when another process holds it, IoError.
  explicit CaseLock(const std::filesystem::path& folder);
  ~CaseLock();
  CaseLock(const CaseLock&) = delete;
  CaseLock& operator=(const CaseLock&) = delete;

  static constexpr const char* file_name = ".lock";

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Name of this machine.
std::string host_name();

}  // namespace granrad
