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
    {"plug", "plug_phi025"},    {"hopper", "moving_bed_4x4"},    {"frozen", "static_phi025"},
    {"dump", "dump_in_hopper"}, {"period", "slab_simple_cubic"}, {"validate", "paper_static"},
    {"sweep", "plug_sweep"}};

/// Folders of the installed data that hold examples: scenes, and studies of them.
constexpr const char* homes[] = {"scenes", "studies"};

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
  std::vector<std::string> names;
  for (const auto& [brief, full] : short_names) names.push_back(brief);
  for (const char* home : homes) {
    const fs::path file = data / home / (name + ".toml");
    if (fs::is_regular_file(file)) return file;
    const auto more = examples(data / home);
    names.insert(names.end(), more.begin(), more.end());
  }
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

/// A text, and the files it names.
struct Copied {
  std::string text;
  std::vector<fs::path> files;
};

/// Only texts in quotes that name a file beside the example are files; the copy names them beside itself.
Copied with_files_beside(const fs::path& from) {
  const std::string text = text_of(from);
  static const std::regex quoted_text("\"([^\"\n]+)\"");
  Copied copied;
  auto rest = text.cbegin();
  for (std::smatch match; std::regex_search(rest, text.cend(), match, quoted_text); rest = match[0].second) {
    const fs::path named = from.parent_path() / match[1].str();
    copied.text.append(rest, match[1].first);
    const bool is_file = fs::is_regular_file(named);
    copied.text += is_file ? named.filename().string() : match[1].str();
    copied.text += '"';
    if (is_file) copied.files.push_back(named.lexically_normal());
  }
  copied.text.append(rest, text.cend());
  return copied;
}

/// Everything an example needs, by the name it gets: its own text first, then the files it names, and what those name.
std::vector<std::pair<std::string, std::string>> gather(const fs::path& from, const std::string& as) {
  const Copied copied = with_files_beside(from);
  std::vector<std::pair<std::string, std::string>> all{{as, copied.text}};
  for (const auto& file : copied.files) {
    const std::string name = file.filename();
    const auto more = file.extension() == ".toml" ? gather(file, name) : decltype(all){{name, text_of(file)}};
    for (const auto& one : more)
      if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
  }
  return all;
}

}  // namespace

int new_scene(const fs::path& file, const std::string& example) {
  const fs::path from = example_file(example), folder = fs::absolute(file).parent_path();
  if (fs::exists(file))
    throw InputError(advised(fmt::format("{}: exists already", file.string()), "choose another name"));
  const auto all = gather(from, file.filename());
  for (std::size_t k = 1; k < all.size(); ++k)
    if (const fs::path target = folder / all[k].first; fs::exists(target) && text_of(target) != all[k].second)
      throw InputError(
          advised(fmt::format("{}: exists already and differs", target.string()), "choose another folder"));
  fs::create_directories(folder);
  for (const auto& [name, text] : all)
    if (!fs::exists(folder / name)) write_text_file(folder / name, text);
  fmt::print("{}  from {}\n", file.string(), from.string());
  for (std::size_t k = 1; k < all.size(); ++k)
    fmt::print("{}\n", (file.parent_path() / all[k].first).string());
  if (from.parent_path().filename() == "studies")
    fmt::print("\ngranrun study {} -o out\n", file.string());
  else
    fmt::print("\ngranrun check {0}\ngranrun run {0} -o out\n", file.string());
  return exit_ok;
}

}  // namespace granrad
