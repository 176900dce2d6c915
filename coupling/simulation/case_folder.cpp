#include "coupling/simulation/case_folder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "coupling/simulation/case_lock.h"

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

/// A name write_text_file, a frame or its series have while they are not whole.
bool is_temporary(const fs::path& file) {
  return file.filename().string().find(".tmp") != std::string::npos;
}

/// What a run that was killed before its first frame may have left behind: nothing of value.
bool holds_only_a_beginning(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == CaseLock::file_name || name == "scene.toml" || name == "inputs" || is_temporary(name))
      continue;
    if (name == "frames" && std::all_of(fs::directory_iterator(entry.path()), fs::directory_iterator(),
                                        [](const auto& file) { return is_temporary(file.path()); }))
      continue;
    return false;
  }
  return true;
}

void refuse_foreign_folder(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder))
    throw InputError(advised(fmt::format("-o {} (is a file)", folder.string()), "name a folder"));
  if (CaseFolder::holds_case(folder))
    throw InputError(advised(fmt::format("-o {} (holds a case already)", folder.string()),
                             "continue it with --resume, or name another folder"));
  if (!holds_only_a_beginning(folder))
    throw InputError(advised(fmt::format("-o {} (not empty, and not one of our cases)", folder.string()),
                             "name an empty or new folder"));
}

void refuse_other_scene(const CaseFolder& folder, const Case& c) {
  const fs::path file = folder.root() / "scene.toml";
  if (read_case(file, {}).identity == c.identity) return;
  throw InputError(advised(
      fmt::format(
          "--resume: the scene differs from {} (a case is continued with the scene and the files it was "
          "started with; only its end, its intervals and its DEM step may change)",
          file.string()),
      "start a new folder instead; [particles] file = a frame of this case takes over its particles, "
      "temperatures and contacts, whatever the engine"));
}

/// Files that were being written when an earlier run was killed.
void remove_temporaries(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& where : {folder, folder / "frames", folder / "inputs"}) {
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(where, ignored))
      if (entry.is_regular_file() && is_temporary(entry.path())) left.push_back(entry.path());
    for (const auto& file : left) fs::remove(file, ignored);
  }
}

void create_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "frames", error);
  if (error) throw IoError(fmt::format("{}: cannot be created ({})", folder.string(), error.message()));
}

}  // namespace

CaseFolder::CaseFolder(const fs::path& folder) : root_(folder) {
  if (!holds_case(folder))
    throw InputError(advised(
        fmt::format("{} (not the folder of a case: run.json or scene.toml is missing)", folder.string()),
        "name the folder given to granrun run -o"));
}

bool CaseFolder::holds_case(const fs::path& folder) {
  return fs::exists(folder / "run.json") && fs::exists(folder / "scene.toml");
}

void CaseFolder::check(const fs::path& folder, const Case& c, bool resume) {
  if (resume && holds_case(folder))
    refuse_other_scene(CaseFolder(folder), c);
  else
    refuse_foreign_folder(folder);
}

CaseFolder CaseFolder::prepare(const fs::path& folder, const Case& c, bool resume) {
  check(folder, c, resume);
  create_folders(folder);
  remove_temporaries(folder);
  copy_inputs(c.inputs, folder);
  write_text_file(folder / "scene.toml", c.portable_text);
  return named(folder);
}

CaseFolder CaseFolder::named(const fs::path& folder) {
  CaseFolder named;
  named.root_ = folder;
  return named;
}

fs::path CaseFolder::frame(std::int64_t step) const {
  return root_ / "frames" / fmt::format("f_{:09d}.hdf", step);
}

std::vector<FrameFile> CaseFolder::frames() const {
  std::vector<FrameFile> all;
  if (!fs::exists(root_ / "frames")) return all;
  for (const auto& entry : fs::directory_iterator(root_ / "frames")) {
    const std::string name = entry.path().filename().string();
    long long step = 0;
    char tail[8] = "";
    if (std::sscanf(name.c_str(), "f_%lld%7s", &step, tail) == 2 && std::string(tail) == ".hdf")
      all.push_back({entry.path(), step});
  }
  std::sort(all.begin(), all.end(), [](const FrameFile& a, const FrameFile& b) { return a.step < b.step; });
  return all;
}

void CaseFolder::add_to_series(std::int64_t step, double time_s) const {
  const fs::path file = root_ / "run.hdf.series";
  std::map<std::string, double> times;
  if (fs::exists(file)) {
    const auto known = nlohmann::json::parse(read_text_file(file), nullptr, false);
    for (const auto& entry :
         known.is_object() ? known.value("files", nlohmann::json::array()) : nlohmann::json())
      if (entry.is_object() && entry.contains("name") && entry.contains("time") && entry["time"].is_number())
        times[entry.value("name", "")] = entry["time"];
  }
  times["frames/" + frame(step).filename().string()] = time_s;
  std::vector<std::pair<fs::path, double>> whole;
  for (const auto& one : frames()) {
    const auto name = "frames/" + one.file.filename().string();
    const auto known = times.find(name);
    whole.emplace_back(one.file, known != times.end() ? known->second : read_frame(one.file).bed.time_s);
  }
  write_series(file, whole);
}

}  // namespace granrad
