#include "coupling/simulation/case_folder.h"

#include <fmt/core.h>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/text_file.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

/// The scene without what a continued run may change.
std::string comparable(const std::string& text) {
  auto document = TomlDocument::from_string(text, "scene.toml");
  document.override_value("scene.end_time_s=1");
  return document.effective_text();
}

void refuse_foreign_folder(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("-o {} (is a file) name a folder", folder.string()));
  if (!fs::is_empty(folder))
    throw InputError(
        fs::exists(folder / "run.json")
            ? fmt::format("-o {} (holds a case already) continue it with --resume, or name another folder",
                          folder.string())
            : fmt::format("-o {} (not empty, and not one of our cases) name an empty or new folder",
                          folder.string()));
}

void refuse_other_scene(const CaseFolder& folder, const Case& c) {
  if (comparable(read_text_file(folder.root() / "scene.toml")) != comparable(c.effective_text))
    throw InputError(
        fmt::format("--resume: the scene differs from {} (a case is continued with the scene it was "
                    "started with; only scene.end_time_s may change) start a new folder instead; [particles] "
                    "file = a frame of this case takes over its particles, temperatures and contacts, "
                    "whatever the engine",
                    (folder.root() / "scene.toml").string()));
}

void create_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "frames", error);
  if (error) throw IoError(fmt::format("{}: cannot be created ({})", folder.string(), error.message()));
}

}  // namespace

CaseFolder::CaseFolder(const fs::path& folder) : root_(folder) {
  if (!fs::exists(root_ / "run.json") || !fs::exists(root_ / "scene.toml"))
    throw InputError(
        fmt::format("{} (not the folder of a case: run.json or scene.toml is missing) name the folder given "
                    "to granrun run -o",
                    folder.string()));
}

void CaseFolder::check(const fs::path& folder, const Case& c, bool resume) {
  if (resume && fs::exists(folder / "run.json"))
    refuse_other_scene(CaseFolder(folder), c);
  else
    refuse_foreign_folder(folder);
}

CaseFolder CaseFolder::prepare(const fs::path& folder, const Case& c, bool resume) {
  check(folder, c, resume);
  create_folders(folder);
  write_text_file(folder / "scene.toml", c.effective_text);
  CaseFolder prepared;
  prepared.root_ = folder;
  return prepared;
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

void CaseFolder::write_series(double step_s) const {
  std::vector<std::pair<fs::path, double>> times;
  for (const auto& frame : frames()) times.emplace_back(frame.file, static_cast<double>(frame.step) * step_s);
  granrad::write_series(root_ / "run.hdf.series", times);
}

std::string read_text_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
  return text.str();
}

}  // namespace granrad
