#include "coupling/granrun/time_loop.h"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

using Clock = std::chrono::steady_clock;

std::string progress_detail(const Simulation& simulation, const HistoryRow& row) {
  std::string text = fmt::format("t = {:.4g} s  N = {}", simulation.bed().time_s, simulation.bed().size());
  if (row["mean_temperature_K"] > 0) text += fmt::format("  T = {:.1f} K", row["mean_temperature_K"]);
  if (std::isfinite(row["h_wp_W_m2K"])) text += fmt::format("  h = {:.1f} W/m2K", row["h_wp_W_m2K"]);
  return text;
}

/// Runs on the first rank what writes into the case, and counts its time.
void write_out(Simulation& simulation, const std::function<void()>& action) {
  const auto begin = std::chrono::steady_clock::now();
  on_first_rank(action);
  simulation.add_output_seconds(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

void save(Simulation& simulation, const CaseFolder& folder) {
  write_out(simulation, [&] {
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

/// Keeps what leads on when a heat step is refused or interrupted in its middle: the state before it.
class LastWholeState {
 public:
  LastWholeState(const Simulation& simulation, const CaseFolder& folder)
      : simulation_(simulation), folder_(folder) {}
  /// Before a step that moves particles or draws radiation; others of a frozen bed cannot fail.
  void keep() {
    if (simulation_.moves() || simulation_.plan().radiation_at(simulation_.tick() + 1))
      simulation_.keep(state_);
  }
  double time_s() const { return state_.bed.time_s; }
  void write() const {
    if (rank() != 0) return;  // and no rank waits for another: it may have failed alone
    const std::int64_t step = state_.bed.step;
    if (state_.state.empty() || std::filesystem::exists(folder_.frame(step))) return;
    write_frame(folder_.frame(step), state_.bed, state_.state);
    folder_.add_to_series(step, state_.bed.time_s);
  }

 private:
  const Simulation& simulation_;
  const CaseFolder& folder_;
  Snapshot state_;
};

/// One heat step; false when a signal stopped it. What refuses it names the way on.
bool advance(Simulation& simulation, LastWholeState& before) {
  const double from_s = simulation.bed().time_s;
  before.keep();
  try {
    simulation.advance();
    return true;
  } catch (const Error& error) {
    before.write();
    if (interrupt_signal()) return false;
    const std::string text = fmt::format(
        "at {:g} s: {}\n  a checkpoint of that time was saved; --resume --set KEY=VALUE goes on from it with another "
        "dem.step_s, radiation.every_s, radiation.rays or conduction.every_steps; particles that fall out of the "
        "scene are taken out by [[remove]]",
        from_s, error.what());
    if (error.exit_code() == exit_bad_input) throw InputError(text);
    throw Error(error.exit_code(), text);
  }
}

void say_stopped(const RunOptions& options, double time_s) {
  say(options, fmt::format("stopped at {:g} s, checkpoint saved; go on with --resume", time_s));
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

/// A feed that could not do what was asked of it.
void remark_on_feed(const Simulation& simulation, const Case& c, const RunOptions& options) {
  constexpr double few = 0.01;  // a bed that is refilled now and then waits for a gap
  const FeedTotals fed = simulation.fed();
  const auto there = static_cast<double>(simulation.bed().size());
  if (c.flow.feed.kind == FeedSettings::Kind::none || static_cast<double>(fed.waiting) <= few * there + 1)
    return;
  say(options,
      fmt::format(
          "note: {} particles of the feed were due and found no room ({:.0f} are in the system); enlarge "
          "feed.fill_region, or ask for fewer at a time",
          fed.waiting, there));
}

}  // namespace

void say(const RunOptions& options, const std::string& text) {
  if (!options.quiet()) print_message(text);
}

int follow(Simulation& simulation, const Case& c, const CaseFolder& folder, const RunOptions& options,
           Clock::time_point start) {
  LastWholeState before(simulation, folder);
  std::optional<HistoryWriter> history;
  std::optional<WallHistoryWriter> walls;
  on_first_rank([&] {
    history.emplace(folder.history(), simulation.last_row_s());
    walls.emplace(folder.wall_history(), simulation.last_row_s());
    if (!history->note().empty()) print_message(fmt::format("note: {}", history->note()));
  });
  if (simulation.bed().step == 0) save(simulation, folder);
  const auto& plan = simulation.plan();
  Progress progress(c.flow.name, plan.time_s(plan.end_tick), options.quiet());
  HistoryRow row;
  while (!simulation.finished()) {
    if (plan.cuts(simulation.tick() + 1)) save(simulation, folder);  // where a longer run goes on
    if (!advance(simulation, before)) {
      say_stopped(options, before.time_s());
      return 128 + interrupt_signal();
    }
    if (plan.row_at(simulation.tick())) {
      const Record record = simulation.record();
      row = record.row;
      write_out(simulation, [&] {
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
      say_stopped(options, simulation.bed().time_s);
      return stop;
    }
  }
  progress.finish();
  remark_on_implicit_radiation(simulation, options);
  remark_on_feed(simulation, c, options);
  if (const auto threads = simulation.flow_threads(); threads.most > 1)
    say(options, fmt::format("threads {} of {} for the flow ({} particles)", threads.used, threads.most,
                             simulation.bed().size()));
  return exit_ok;
}

}  // namespace granrad
