#include "dem/base/problem_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

namespace granrad {

namespace {

std::string location(const Place& place) {
  if (place.line == 0 || place.file.starts_with(override_mark)) return place.file + ": ";
  return fmt::format("{}:{}:{}: ", place.file, place.line, place.column);
}

}  // namespace

std::vector<std::string> ProblemList::lines(const std::string& main_file) const {
  const auto rank = [&](const Problem& p) {
    const int group = p.place.file == main_file ? 0 : p.place.file.starts_with(override_mark) ? 2 : 1;
    return std::tuple(group, p.place.file, p.place.line, p.place.column);
  };
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Problem& a, const Problem& b) { return rank(a) < rank(b); });
  std::vector<std::string> lines;
  for (const auto& p : sorted) {
    std::string line = location(p.place) + p.text;
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace granrad
