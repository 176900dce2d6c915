#include "coupling/granrun/run.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "coupling/granrun/case_notes.h"
#include "coupling/granrun/run_record.h"
#include "coupling/results/results.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/case_lock.h"
#include "coupling/simulation/simulation.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/io/export_text.h"
#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

using Clock = std::chrono::steady_clock;

void say(const RunOptions& options, const std::string& text) {
  if (!options.quiet()) fmt::print(stderr, "{}\n", text);
}

/// Goes on from the last frame that can be read and leads on; a damaged one is reported, and the frame before it
/// taken. False when the case has no frame yet. Throws IoError when it has some and none serves: its history is
/// left as it is.
bool resume_from_last_frame(Simulation& simulation, const CaseFolder& folder, const RunOptions& options) {
  const auto frames = folder.frames();
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    try {
      if (!simulation.resume(read_frame(frame->file))) continue;
      say(options, fmt::format("resumed from {} at {:g} s", frame->file.string(), simulation.bed().time_s));
      return true;
    } catch (const Error& error) {
      fmt::print(stderr, "{}\n  skipped: trying the frame before\n", error.what());
    }
  }
  if (frames.empty() && read_history(folder.history()).at("time_s").empty()) return false;
  throw IoError(advised(fmt::format("--resume: no frame of {} can be read", folder.root().string()),
                        "nothing was changed there; start a new folder, or put back a frame into frames/"));
}

/// Starts the case, or goes on with it.
void begin(Simulation& simulation, const Case& c, const std::filesystem::path& where,
           const RunOptions& options) {
  if (options.resume && CaseFolder::holds_case(where) &&
      resume_from_last_frame(simulation, CaseFolder(where), options)) {
    if (simulation.plan().end_step < simulation.bed().step)
      throw InputError(advised(fmt::format("scene.end_time_s = {:g} s (the case is at {:g} s already)",
                                           c.flow.end_time_s, simulation.bed().time_s),
                               "give a later end, or start a new folder"));
  } else {
    simulation.start();
    for (const auto& note : case_notes(c, simulation.bed())) say(options, "note: " + note);
    for (const auto& note : simulation.notes()) say(options, "note: " + note);
    const double every_s = c.heat.radiation.every_s, motion_s = simulation.limits().motion_s;
    if (c.heat.radiation.kind != RadiationKind::none && every_s > motion_s)
      say(options, fmt::format("note: particles move more than their diameter between radiation updates "
                               "(radiation.every_s = {:g} s); {:.2g} s follows the flow",
                               every_s, motion_s));
  }
  if (const auto note = end_note(simulation.plan(), c.flow.end_time_s); !note.empty())
    say(options, "note: " + note);
}

/// What long radiation intervals cost in accuracy.
void remark_on_implicit_radiation(const Simulation& simulation, const RunOptions& options) {
  const auto& totals = simulation.heat().radiation();
  if (totals.implicit_updates == 0) return;
  say(options,
      fmt::format("note: {} of {} radiation updates were longer than 0.1 of the radiative time constant and "
                  "taken implicitly, to first order; radiation.every_s = \"auto\" follows the time constant",
                  totals.implicit_updates, totals.updates));
  if (totals.limited_share > 0)
    say(options,
        fmt::format("note: up to {:.2g} % of the heats of an update were noise beyond every temperature and "
                    "moved back; more rays make it less",
                    100 * totals.limited_share));
}

std::string progress_detail(const Simulation& simulation, const HistoryRow& row) {
  std::string text = fmt::format("t = {:.4g} s  N = {}", simulation.bed().time_s, simulation.bed().size());
  if (row["mean_temperature_K"] > 0) text += fmt::format("  T = {:.1f} K", row["mean_temperature_K"]);
  if (std::isfinite(row["h_wp_W_m2K"])) text += fmt::format("  h = {:.1f} W/m2K", row["h_wp_W_m2K"]);
  return text;
}

void save(const Simulation& simulation, const CaseFolder& folder) {
  on_first_rank([&] {
    simulation.write_checkpoint(folder.frame(simulation.bed().step));
    folder.add_to_series(simulation.bed().step, simulation.bed().time_s);
  });
}

/// 0 to go on, else the exit code to stop with, the same on every rank.
int stop_requested(const RunOptions& options, Clock::time_point start) {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
  const int own = interrupt_signal()              ? 128 + interrupt_signal()
                  : elapsed >= options.walltime_s ? exit_wall_time
                                                  : 0;
  return static_cast<int>(largest_over_ranks(own));
}

/// One tick. What stops it names the way on: the frames before it are whole.
void advance(Simulation& simulation) {
  const double from_s = simulation.bed().time_s;
  try {
    simulation.advance();
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format(
        "at {:g} s: {}\n  the last frame leads on with --resume --set KEY=VALUE (dem.step_s, radiation.every_s, "
        "conduction.every_steps); particles that fall out of the scene are taken out by [[remove]]",
        from_s, error.what()));
  }
}

/// The time loop, from where the simulation stands to its end or until it must stop.
int follow(Simulation& simulation, const Case& c, const CaseFolder& folder, const RunOptions& options,
           Clock::time_point start) {
  std::optional<HistoryWriter> history;
  std::optional<WallHistoryWriter> walls;
  on_first_rank([&] {
    history.emplace(folder.history(), simulation.last_row_s());
    walls.emplace(folder.wall_history(), simulation.last_row_s());
    if (!history->note().empty()) fmt::print(stderr, "note: {}\n", history->note());
  });
  if (simulation.bed().step == 0) save(simulation, folder);
  const auto& plan = simulation.plan();
  Progress progress(c.flow.name, plan.time_s(plan.end_tick), options.quiet());
  HistoryRow row;
  while (!simulation.finished()) {
    if (plan.cuts(simulation.tick() + 1)) save(simulation, folder);  // where a longer run goes on
    advance(simulation);
    if (plan.row_at(simulation.tick())) {
      const Record record = simulation.record();
      row = record.row;
      on_first_rank([&] {
        history->append(row);
        walls->append(record.walls);
      });
      if (options.verbose())
        fmt::print(stderr, "{}  threads {} of {}\n", progress_detail(simulation, row),
                   simulation.flow_threads().used, simulation.flow_threads().most);
    }
    const int stop = stop_requested(options, start);
    const bool asked = largest_over_ranks(take_checkpoint_request()) != 0;
    if (stop || asked || plan.frame_at(simulation.tick())) save(simulation, folder);
    progress.update(simulation.bed().time_s, progress_detail(simulation, row));
    if (stop && !simulation.finished()) {
      say(options,
          fmt::format("stopped at {:g} s, checkpoint saved; go on with --resume", simulation.bed().time_s));
      return stop;
    }
  }
  progress.finish();
  remark_on_implicit_radiation(simulation, options);
  if (const auto threads = simulation.flow_threads(); threads.most > 1)
    say(options, fmt::format("threads {} of {} for the flow ({} particles)", threads.used, threads.most,
                             simulation.bed().size()));
  return exit_ok;
}

/// Whether a case is done as it stands: its record says so, for this end, and its history reaches it.
bool is_done(const std::filesystem::path& where, const Case& c) {
  if (!CaseFolder::holds_case(where) || !is_finished(where)) return false;
  const CaseFolder folder(where);
  const auto record = read_run_record(folder);
  const auto& times = read_history(folder.history()).at("time_s");
  const double rounding = 1e-9 * record.end_time_s;
  return !times.empty() && std::abs(times.back() - record.end_time_s) <= rounding &&
         read_case(where / "scene.toml", {}).effective_text == c.portable_text;
}

}  // namespace

int run_case(const Case& c, const std::filesystem::path& where, const RunOptions& options) {
  const auto start = Clock::now();
  install_signal_handlers();
  CaseFolder::check(where, c, options.resume);
  std::optional<CaseLock> lock;
  on_first_rank([&] {
    if (std::filesystem::exists(where)) lock.emplace(where);
  });
  if (options.resume && is_done(where, c)) {
    say(options, fmt::format("{}: finished already, nothing was changed; a later scene.end_time_s goes on",
                             where.string()));
    return exit_ok;
  }
  Simulation simulation(c, options.threads);
  begin(simulation, c, where, options);
  on_first_rank([&] {
    if (!lock) lock.emplace(where);
    write_run_record(CaseFolder::prepare(where, c, options.resume), c, simulation, options);
    write_text_file(where / "walls.vtp", walls_vtp_text(simulation.bed()));
  });
  const CaseFolder folder = CaseFolder::named(where);
  const int stop = follow(simulation, c, folder, options, start);
  on_first_rank([&] {
    if (stop) return write_run_record(folder, c, simulation, options);
    const Results results = summarise(folder, c);
    write_results(folder, c, results);
    write_run_record(folder, c, simulation, options, &results);
    if (!options.quiet()) print_results(c, results, simulation, folder);
  });
  return stop;
}

}  // namespace granrad
