#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// A frame on disk, known by its name alone: frames/f_000001000.hdf is the state after 1000 steps.
struct FrameFile {
  std::filesystem::path file;
  std::int64_t step = 0;
};

/// The folder of one case:
///   scene.toml       the scene in force, overrides included
///   run.json         version, git commit, seeds, hash of the scene, and the results when finished
///   history.csv      one row per output interval
///   frames/          checkpoints and pictures at once;  run.hdf.series gives their times
class CaseFolder {
 public:
  /// Throws the InputErrors of `prepare` without touching anything.
  static void check(const std::filesystem::path& folder, const Case& c, bool resume);
  /// Starts a case in a folder that is empty or absent, or goes on with one (`resume`) whose scene is the
  /// same but for scene.end_time_s. Throws InputError (folder in use, scene differs, nothing to resume),
  /// IoError.
  static CaseFolder prepare(const std::filesystem::path& folder, const Case& c, bool resume);
  /// A case that is there already. Throws InputError when it is not ours.
  explicit CaseFolder(const std::filesystem::path& folder);

  std::filesystem::path root() const { return root_; }
  std::filesystem::path history() const { return root_ / "history.csv"; }
  std::filesystem::path run_json() const { return root_ / "run.json"; }
  std::filesystem::path frame(std::int64_t step) const;
  std::vector<FrameFile> frames() const;  ///< whole ones, by step
  /// run.hdf.series: every frame of the folder with its time, for ParaView.
  void write_series(double step_s) const;

 private:
  CaseFolder() = default;
  std::filesystem::path root_;
};

std::string read_text_file(const std::filesystem::path& file);  ///< throws IoError

}  // namespace granrad
