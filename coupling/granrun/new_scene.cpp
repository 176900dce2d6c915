#include "coupling/granrun/new_scene.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <vector>

#include "dem/base/error.h"
#include "dem/base/files/data_folder.h"
#include "dem/base/files/text_file.h"
#include "dem/base/suggestion.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

/// Short names of the examples most will want.
const std::pair<const char*, const char*> short_names[] = {
    {"plug", "plug_phi025"}, {"hopper", "moving_bed_4x4"}, {"frozen", "static_phi025"}};

std::vector<std::string> examples(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path example_file(const std::string& asked) {
  const fs::path data = data_folder();
  if (data.empty())
    throw IoError(
        advised("the examples are not installed", "set GRANRAD_DATA to the folder that has scenes/"));
  std::string name = asked;
  for (const auto& [brief, full] : short_names)
    if (name == brief) name = full;
  const fs::path file = data / "scenes" / (name + ".toml");
  if (fs::is_regular_file(file)) return file;
  auto names = examples(data / "scenes");
  for (const auto& [brief, full] : short_names) names.push_back(brief);
  const std::string meant = closest_word(asked, names);
  throw InputError(fmt::format("--from = {} (no such example); {}", asked,
                               meant.empty() ? fmt::format("try one of {}", fmt::join(names, ", "))
                                             : fmt::format("did you mean {}?", meant)));
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int new_scene(const fs::path& file, const std::string& example) {
  const fs::path from = example_file(example);
  const fs::path folder = fs::absolute(file).parent_path();
  if (fs::exists(file))
    throw InputError(advised(fmt::format("{}: exists already", file.string()), "choose another name"));
  std::string text = text_of(from), out;
  // Only texts in quotes that name a file beside the example are files.
  static const std::regex quoted_text("\"([^\"\\n]+)\"");
  std::vector<fs::path> copied;
  auto rest = text.cbegin();
  for (std::smatch match; std::regex_search(rest, text.cend(), match, quoted_text); rest = match[0].second) {
    const fs::path named = from.parent_path() / match[1].str();
    out.append(rest, match[1].first);
    const bool is_file = fs::is_regular_file(named);
    out += is_file ? named.filename().string() : match[1].str();
    out += '"';
    if (is_file) copied.push_back(named.lexically_normal());
  }
  out.append(rest, text.cend());
  fs::create_directories(folder);
  for (const auto& source : copied) {
    const fs::path target = folder / source.filename();
    if (!fs::exists(target))
      write_text_file(target, text_of(source));
    else if (text_of(target) != text_of(source))
      throw InputError(
          advised(fmt::format("{}: exists already and differs", target.string()), "choose another folder"));
  }
  write_text_file(file, out);
  fmt::print("{}  from {}\n", file.string(), from.string());
  for (const auto& source : copied) fmt::print("{}\n", (file.parent_path() / source.filename()).string());
  fmt::print("\ngranrun check {0}\ngranrun run {0} -o out\n", file.string());
  return exit_ok;
}

}  // namespace granrad
