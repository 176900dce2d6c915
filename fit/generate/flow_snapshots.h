#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dem/base/toml/toml_reader.h"
#include "fit/generate/flow_run.h"
#include "fit/trace/snapshot_enclosure.h"
#include "fit/trace/trace_snapshot.h"

namespace granrad {

/// [flow] of `vfgen generate`: where snapshots come from when they are not packed. One of `scene`, `folders` and
/// `files`:
///
///   scene = "plug_phi*.toml"   # scenes to run, by * and ? (beside the config); each is a row
///   solid_fractions = [...]    # of a plug: a row each, the (one) scene with feed.solid_fraction set to it
///   set = ["key=value"]        # for every run
///   seeds = 2                  # runs of each row, with feed.seed = 1, 2, ...
///   folders = ["runs/*"]       # or: folders of granrun run; each is a row
///   files = ["dump.*"]         # or: snapshots of any kind that vfgen trace reads; rows by solid fraction
///   walls = ["box.stl:0.001"], box_size_m, box_origin_m, radius_m    # of files without walls or radii
///   start_s = 0                # flows are judged from here on (after an outlet opens)
///   every_s = 0.05             # of history and frames of the runs
///   most_time_s = 20           # simulated time of a run, at most
///   snapshots = 4              # of each row, at least
///   most_snapshots = 16
///   curve_error = 0.01         # sampling error wanted of mean F_pp at 1.5 < d* < 2.5, relative
///
/// A run goes on until it is steady (flow_run.h) and long enough for its snapshots, taken one residence time
/// apart. Snapshots are added until the error is reached, or most_snapshots.
struct FlowSettings {
  std::vector<std::filesystem::path> scenes, folders, files;
  std::vector<double> solid_fractions;
  std::vector<std::string> set;
  EnclosureSettings enclosure;
  int seeds = 2, snapshots = 4, most_snapshots = 16;
  double start_s = 0, every_s = 0.05, most_time_s = 20, curve_error = 0.01;
  bool present() const { return !scenes.empty() || !folders.empty() || !files.empty(); }
};

/// Reads [flow]; problems go to the document.
FlowSettings read_flow_settings(TomlTable table, const std::filesystem::path& beside);

/// One row to be: a scene at one solid fraction, or a folder.
struct FlowRow {
  std::string name;
  std::vector<FlowRun> runs;  ///< one a seed
  bool made = false;          ///< a folder that is there: not to be run
};
std::vector<FlowRow> flow_rows(const FlowSettings& settings, const std::filesystem::path& folder);

/// Snapshots of a row, at least `count` where the runs can give so many; runs them as far as it takes, telling
/// `say`. Empty when interrupted. Throws NumericalError when a run is not steady after most_time_s, and what
/// advance_to throws.
std::vector<std::filesystem::path> take_snapshots(const FlowRow& row, const FlowSettings& settings,
                                                  std::size_t count, int threads,
                                                  const std::function<void(const std::string&)>& say);

}  // namespace granrad
