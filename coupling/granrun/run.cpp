#include "coupling/granrun/run.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "coupling/granrun/case_notes.h"
#include "coupling/granrun/run_record.h"
#include "coupling/granrun/time_loop.h"
#include "coupling/results/results.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/case_lock.h"
#include "coupling/simulation/simulation.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/io/export_text.h"
#include "dem/io/saved_state.h"
#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

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
      print_message(fmt::format("{}\n  skipped: trying the frame before", error.what()));
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

/// A finished case is worth its last frame: a damaged one, or one of another scene, is made again from the frame before.
bool last_frame_is_whole(const CaseFolder& folder, const Case& c) {
  const auto frames = folder.frames();
  try {
    return !frames.empty() && saved_integer(saved_block(read_frame(frames.back().file), "case"),
                                            "identity") == static_cast<std::int64_t>(text_hash(c.identity));
  } catch (const Error&) {
    return false;
  }
}

/// Whether a case is done as it stands: its record says so, for this end, its history reaches it and its last frame can
/// be read.
bool is_done(const std::filesystem::path& where, const Case& c) {
  if (!CaseFolder::holds_case(where) || !is_finished(where)) return false;
  const CaseFolder folder(where);
  const auto record = read_run_record(folder);
  const History history = read_history(folder.history());
  const auto& times = history.at("time_s");
  const double rounding = 1e-9 * record.end_time_s;
  return !times.empty() && std::abs(times.back() - record.end_time_s) <= rounding &&
         read_case(where / "scene.toml", {}).effective_text == c.portable_text &&
         last_frame_is_whole(folder, c);
}

}  // namespace

int run_case(const Case& c, const std::filesystem::path& where, const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
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
