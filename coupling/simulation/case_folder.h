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
///   scene.toml       the scene in force, overrides included; it runs anywhere, beside
///   inputs/          copies of the files it names
///   run.json         where the results came from, and the results when finished
///   history.csv      one row per output interval;  walls.csv  one row per wall and interval
///   frames/          checkpoints and pictures at once;  run.hdf.series gives their times
/// Whoever writes into it holds its lock (case_lock.h).
class CaseFolder {
 public:
  /// Throws the InputErrors of `prepare` without touching anything.
  static void check(const std::filesystem::path& folder, const Case& c, bool resume);
  /// Starts a case in a folder that is empty, absent or was left before its first frame; or goes on with one
  /// (`resume`) whose scene leads on from its frames (Case::identity). Throws InputError (folder in use, scene
  /// differs, nothing to resume), IoError. Precondition: the folder is locked by the caller.
  static CaseFolder prepare(const std::filesystem::path& folder, const Case& c, bool resume);
  /// A case that is there already. Throws InputError when it is not ours.
  explicit CaseFolder(const std::filesystem::path& folder);
  /// A folder as it is or will be, unchecked: for ranks that do not write there.
  static CaseFolder named(const std::filesystem::path& folder);
  /// Whether the folder holds a case that got as far as its record.
  static bool holds_case(const std::filesystem::path& folder);

  std::filesystem::path root() const { return root_; }
  std::filesystem::path history() const { return root_ / "history.csv"; }
  std::filesystem::path wall_history() const { return root_ / "walls.csv"; }
  std::filesystem::path results() const { return root_ / "results.json"; }
  std::filesystem::path run_json() const { return root_ / "run.json"; }
  std::filesystem::path frame(std::int64_t step) const;
  std::vector<FrameFile> frames() const;  ///< whole ones, by step
  /// Adds a frame to run.hdf.series, which gives ParaView every frame of the folder with its time.
  void add_to_series(std::int64_t step, double time_s) const;

 private:
  CaseFolder() = default;
  std::filesystem::path root_;
};

}  // namespace granrad
