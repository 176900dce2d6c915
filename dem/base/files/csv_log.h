#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// A table on disk that grows while a run goes on: comma-separated, its first column the time in s. Each row
/// reaches the disk before the next is computed.
class CsvLog {
 public:
  /// Starts a new file, or goes on after the rows up to `last_row_s` > 0 and drops later ones, and one cut short
  /// by a crash. Throws IoError.
  CsvLog(const std::filesystem::path& file, const std::string& header, double last_row_s);
  void append(const std::string& rows);
  /// What is wrong with the rows that were there: their last is not that of `last_row_s`. Empty when nothing is.
  const std::string& note() const { return note_; }

 private:
  std::filesystem::path file_;
  std::string note_;
};

}  // namespace granrad
