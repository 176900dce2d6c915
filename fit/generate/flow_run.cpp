#include "fit/generate/flow_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/io/snapshot.h"
#include "fit/generate/child_program.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;

/// Mean of the values known at times in [from, to); NaN without any.
double mean_between(const std::vector<double>& time, const std::vector<double>& value, double from,
                    double to) {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] >= from && time[k] < to && std::isfinite(value[k])) sum += value[k], ++count;
  return sum / count;
}

double change(const std::vector<double>& time, const std::vector<double>& value, double from, double to) {
  const double middle = 0.5 * (from + to), first = mean_between(time, value, from, middle),
               second = mean_between(time, value, middle, to);
  return std::abs(second - first) / std::max(std::abs(first), std::abs(second));
}

std::string last_lines(const fs::path& log) {
  std::ifstream in(log);
  std::string text, line;
  while (std::getline(in, line)) text = line.empty() ? text : line;
  return text;
}

}  // namespace

SteadyState judge_steadiness(const fs::path& history, double start_s) {
  constexpr double most_drift = 0.01, most_velocity_drift = 0.10, least_rows = 6;
  const CsvTable table = read_csv(history);
  for (const char* name : {"time_s", "solid_fraction", "mean_velocity_m_s", "residence_time_s"})
    if (table.find(name) == CsvTable::nowhere)
      throw InputError(
          advised(fmt::format("{}: no column {} (not the history of a run)", history.string(), name),
                  "give a folder that granrun run has written"));
  const auto time = table.numbers("time_s"), phi = table.numbers("solid_fraction");
  SteadyState state;
  if (time.empty() || time.back() <= start_s) return state;
  const double end = time.back() * (1 + 1e-12) + 1e-300;
  state.from_s = 0.5 * (start_s + time.back());
  const double residence = mean_between(time, table.numbers("residence_time_s"), state.from_s, end);
  state.residence_s = std::isfinite(residence) ? residence : 0;
  state.drift = change(time, phi, state.from_s, end);
  const double faster =
      state.residence_s > 0 ? change(time, table.numbers("mean_velocity_m_s"), state.from_s, end) : 0;
  const auto rows = std::count_if(time.begin(), time.end(), [&](double t) { return t >= state.from_s; });
  state.reached = static_cast<double>(rows) >= least_rows && state.drift < most_drift &&
                  faster < most_velocity_drift && time.back() - state.from_s >= 0.5 * state.residence_s;
  return state;
}

double reached_s(const fs::path& folder) {
  if (!fs::exists(folder / "history.csv")) return 0;
  const CsvTable table = read_csv(folder / "history.csv");
  return table.rows.empty() ? 0 : table.numbers("time_s").back();
}

bool advance_to(const FlowRun& run, double end_s, int threads) {
  if (reached_s(run.folder) >= end_s * (1 - 1e-9)) return true;
  std::vector<std::string> arguments = {
      "run",   run.scene.string(),     "-o", run.folder.string(), "--resume", "-q",
      "--set", "radiation.source=none"};
  const auto set = [&](const std::string& assignment) {
    arguments.insert(arguments.end(), {"--set", assignment});
  };
  for (const auto& assignment : run.set) set(assignment);
  set(fmt::format("output.every_s={}", run.every_s));
  set(fmt::format("output.frames_every_s={}", run.every_s));
  set(fmt::format("scene.end_time_s={}", end_s));
  if (threads > 0) arguments.insert(arguments.end(), {"--threads", fmt::format("{}", threads)});
  const fs::path log = run.folder.string() + ".log";
  const int code = run_child(sibling_program("granrun"), arguments, log);
  if (code == 130 || code == 143 || code == 128 + 2 || code == 128 + 15) return false;
  if (code == 0) return true;
  const auto text = fmt::format("granrun run {} ended with code {}: {} (all it said: {})", run.scene.string(),
                                code, last_lines(log), log.string());
  if (code == exit_bad_input) throw InputError(text);
  if (code == exit_io_failure) throw IoError(text);
  throw NumericalError(text);
}

std::vector<fs::path> spaced_frames(const fs::path& folder, const SteadyState& steady, std::size_t count) {
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(folder / "frames"))
    if (entry.path().extension() == ".hdf") frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  std::vector<fs::path> chosen;
  double next_s = steady.from_s;
  for (const auto& frame : frames) {
    if (chosen.size() == count) break;
    const double time = read_frame(frame).bed.time_s;
    if (time < next_s * (1 - 1e-9)) continue;
    chosen.push_back(frame);
    if (!(steady.residence_s > 0)) break;
    next_s = time + steady.residence_s;
  }
  return chosen;
}

}  // namespace granrad
