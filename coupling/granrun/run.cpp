#include "coupling/granrun/run.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>

#include "coupling/granrun/results.h"
#include "coupling/granrun/run_record.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/simulation.h"
#include "dem/base/error.h"
#include "dem/base/program.h"

namespace granrad {

namespace {

using Clock = std::chrono::steady_clock;

/// The last frame that can be read and leads on; a damaged one is reported and passed over.
bool resume_from_last_frame(Simulation& simulation, const CaseFolder& folder, const RunOptions& options) {
  const auto frames = folder.frames();
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    try {
      if (!simulation.resume(read_frame(frame->file))) continue;
      if (!options.quiet())
        fmt::print(stderr, "resumed from {} at {:g} s\n", frame->file.string(), simulation.bed().time_s);
      return true;
    } catch (const IoError& error) {
      fmt::print(stderr, "{}\n  passed over: trying the frame before\n", error.what());
    }
  }
  return false;
}

void warn_about_motion(const Case& c, const Simulation& simulation) {
  if (c.heat.radiation.kind != RadiationKind::none && c.heat.radiation.every_s > simulation.limits().motion_s)
    fmt::print(stderr,
               "note: particles move more than their diameter between radiation updates (radiation.every_s = "
               "{:g} s); "
               "{:.2g} s follows the flow\n",
               c.heat.radiation.every_s, simulation.limits().motion_s);
}

void warn_about_end(const Case& c, const Simulation& simulation) {
  const auto note = end_note(simulation.plan(), c.flow.end_time_s);
  if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
}

std::string progress_detail(const Simulation& simulation, const HistoryRow& row) {
  std::string text = fmt::format("t = {:.4g} s  N = {}", simulation.bed().time_s, simulation.bed().size());
  if (row.mean_temperature_K > 0) text += fmt::format("  T = {:.1f} K", row.mean_temperature_K);
  if (std::isfinite(row.h_wp_W_m2K)) text += fmt::format("  h = {:.1f} W/m2K", row.h_wp_W_m2K);
  return text;
}

void save(const Simulation& simulation, const CaseFolder& folder) {
  simulation.write_checkpoint(folder.frame(simulation.bed().step));
  folder.write_series(simulation.plan().step_s);
}

/// 0 to go on, else the exit code to stop with.
int stop_requested(const RunOptions& options, Clock::time_point begin) {
  if (interrupt_signal()) return 128 + interrupt_signal();
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
  return elapsed >= options.walltime_s ? exit_wall_time : 0;
}

}  // namespace

int run_case(const Case& c, const std::filesystem::path& where, const RunOptions& options) {
  const auto begin = Clock::now();
  install_signal_handlers();
  CaseFolder::check(where, c, options.resume);
  Simulation simulation(c, options.threads);
  if (!options.resume || !std::filesystem::exists(where / "run.json") ||
      !resume_from_last_frame(simulation, CaseFolder(where), options)) {
    simulation.start();
    if (!options.quiet()) warn_about_motion(c, simulation);
  }
  if (!options.quiet()) warn_about_end(c, simulation);
  const CaseFolder folder = CaseFolder::prepare(where, c, options.resume);
  write_run_record(folder, c, simulation);
  HistoryWriter history(folder.history(), simulation.bed().time_s);
  if (simulation.tick() == 0) save(simulation, folder);

  const auto& plan = simulation.plan();
  Progress progress(c.flow.name, plan.time_s(plan.end_tick), options.quiet());
  HistoryRow row;
  while (!simulation.finished()) {
    if (plan.cuts(simulation.tick() + 1)) save(simulation, folder);  // where a longer run goes on
    simulation.advance();
    if (plan.row_at(simulation.tick())) history.append(row = simulation.row());
    const int stop = stop_requested(options, begin);
    if (stop || plan.frame_at(simulation.tick())) save(simulation, folder);
    progress.update(simulation.bed().time_s, progress_detail(simulation, row));
    if (stop && !simulation.finished()) {
      if (!options.quiet())
        fmt::print(stderr, "stopped at {:g} s, checkpoint saved; go on with --resume\n",
                   simulation.bed().time_s);
      return stop;
    }
  }
  progress.finish();
  const Results results = summarise(read_history(folder.history()));
  write_run_record(folder, c, simulation, &results);
  if (!options.quiet()) print_results(c, results, simulation, folder);
  return exit_ok;
}

}  // namespace granrad
