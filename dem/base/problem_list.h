#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// Where something stands; line 0: no place inside the file.
struct Place {
  std::string file;
  std::uint32_t line = 0, column = 0;
};

/// "File" of what was given on the command line starts with this.
inline constexpr std::string_view override_mark = "--set ";

/// Problems of an input, reported all at once.
class ProblemList {
 public:
  void add(Place place, std::string text) { problems_.push_back({std::move(place), std::move(text)}); }
  /// `file:line:col: text` of each, once, by position: the main file, other files, overrides.
  std::vector<std::string> lines(const std::string& main_file) const;

 private:
  struct Problem {
    Place place;
    std::string text;
  };
  std::vector<Problem> problems_;
};

}  // namespace granrad
