#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// When a flow is steady, and how long a particle stays in it.
struct SteadyState {
  bool reached = false;
  double from_s = 0;       ///< the second half of the time after the start asked for
  double residence_s = 0;  ///< mean mass in the region over mass flow out; 0: nothing leaves
  double drift = 0;        ///< of the solid fraction between the two halves of that time, relative
};

/// Judges history.csv of a run: steady when over the second half of the time since `start_s` the means of the
/// solid fraction in its first and second half differ by less than 1 % and those of the mean velocity by less
/// than 10 %, and that half is at least half a residence time long. Throws InputError for a history without
/// the columns it needs, IoError.
SteadyState judge_steadiness(const std::filesystem::path& history, double start_s);

/// A run of granrun that snapshots are taken from.
struct FlowRun {
  std::filesystem::path scene, folder;
  std::vector<std::string> set;  ///< key=value for granrun
  double every_s = 0.05;         ///< of its history and frames
};

/// Runs it, or goes on, to `end_s` of simulated time: granrun as a child process, without radiation. Nothing is
/// done when it has come so far. False when interrupted. Throws Error with what granrun said.
bool advance_to(const FlowRun& run, double end_s, int threads);
/// Time of the last row of its history; 0 without one.
double reached_s(const std::filesystem::path& folder);

/// Frames of a run one residence time apart from steadiness on, at most `count` (one when nothing leaves).
std::vector<std::filesystem::path> spaced_frames(const std::filesystem::path& folder,
                                                 const SteadyState& steady, std::size_t count);

}  // namespace granrad
