#include <fmt/core.h>
#include <fnmatch.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

/// Text before digits, the digits as a number, and so on: f_9 stands before f_10.
bool in_natural_order(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::string x = a.string(), y = b.string();
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 0, j = 0; i < x.size() && j < y.size();) {
    if (!is_digit(x[i]) || !is_digit(y[j])) {
      if (x[i] != y[j]) return x[i] < y[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& text, std::size_t& at) {
      const std::size_t begin = std::min(text.find_first_not_of('0', at), text.size());
      while (at < text.size() && is_digit(text[at])) ++at;
      return begin < at ? text.substr(begin, at - begin) : std::string();
    };
    const std::string m = number(x, i), n = number(y, j);
    if (m.size() != n.size()) return m.size() < n.size();
    if (m != n) return m < n;
  }
  return x.size() < y.size();
}

/// Files whose name fits a pattern with * and ?; folders are named without them.
std::vector<std::filesystem::path> files_like(const std::filesystem::path& pattern) {
  std::vector<std::filesystem::path> found;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(pattern.parent_path(), absent))
    if (fnmatch(pattern.filename().c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0 &&
        entry.is_regular_file())
      found.push_back(entry.path());
  std::sort(found.begin(), found.end(), in_natural_order);
  return found;
}

}  // namespace

void read_replay(TomlTable& table, Scene& scene) {
  const bool replay = scene.engine == EngineKind::replay;
  const auto pattern = table.pattern(
      {"files", "of replay: the recorded snapshots, * and ? stand for any text: \"dump.*.liggghts\""});
  const std::string between =
      table.choice({"between", "of replay: the nearest snapshot, or the line between two"},
                   {"stepped", "interpolated"}, "stepped");
  if (!replay) {
    for (const char* key : {"files", "between"})
      if (table.has(key)) table.problem(key, "is of engine = \"replay\" alone");
    return;
  }
  scene.replay.interpolated = between == "interpolated";
  if (pattern.empty())
    return table.problem("files", "is missing: the files of the recorded flow, such as \"dump.*.liggghts\"");
  scene.replay.files = files_like(pattern);
  if (scene.replay.files.empty()) table.problem("files", "no file has such a name");
  if (scene.feed.kind != FeedSettings::Kind::none)
    table.problem("engine",
                  advised("= \"replay\" (what enters and leaves is in the recording)", "leave [feed] out"));
}

}  // namespace granrad
