#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// One kind of file that users give the programs: `feed` reads bytes as that kind. An Error of ours is a right
/// answer; anything else that leaves the function, a crash, a hang or a report of a sanitizer is a finding.
struct FileTarget {
  std::string name;  ///< of its corpus, tests/fuzz/corpus/NAME
  void (*feed)(std::string_view bytes);
};

const std::vector<FileTarget>& file_targets();

}  // namespace granrad
