#include "coupling/study/case_queue.h"

#include <fmt/core.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "coupling/simulation/case_folder.h"
#include "coupling/study/case_record.h"
#include "coupling/study/child_process.h"
#include "dem/base/error.h"
#include "dem/base/program.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t log_lines_shown = 8;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The last lines that a case printed before it failed.
std::string last_lines(const fs::path& log) {
  std::vector<std::string> lines;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  std::string text;
  for (std::size_t k = lines.size() > log_lines_shown ? lines.size() - log_lines_shown : 0; k < lines.size();
       ++k)
    text += (text.empty() ? "" : "\n") + lines[k];
  return text;
}

/// Part of a run that is done: the last time of its history over its end.
double part_done(const fs::path& folder) {
  std::ifstream history(folder / "history.csv"), record(folder / "run.json");
  const auto json = nlohmann::json::parse(record, nullptr, false);
  if (!history || !json.is_object() || !json.contains("steps")) return 0;
  const double end = json["steps"].value("end_time_s", 0.0);
  history.seekg(0, std::ios::end);
  history.seekg(std::max<std::streamoff>(0, static_cast<std::streamoff>(history.tellg()) - 4096));
  double last = 0;
  for (std::string line; std::getline(history, line);)
    if (const double time = std::strtod(line.c_str(), nullptr); time > last && time <= end * 1.001)
      last = time;
  return end > 0 ? std::min(1.0, last / end) : 0;
}

enum class State { waiting, running, finished, failed };

struct Entry {
  const StudyCase* of;
  CasePlace place;
  CaseRecord record;
  State state = State::waiting;
  pid_t child = 0;
  Clock::time_point begin{};
};

class Queue {
 public:
  Queue(const Study& study, const fs::path& folder, const StudyOptions& options)
      : study_(study), folder_(folder), options_(options) {
    for (const auto& one : study.cases)
      if (!one.skipped) entries_.push_back({&one, place_of(folder, one), {}});
    jobs_ = options.jobs > 0 ? options.jobs : omp_get_num_procs();
    threads_ = std::max(1, options.run.threads);
  }

  int run() {
    install_signal_handlers();
    prepare_all();
    if (std::all_of(entries_.begin(), entries_.end(),
                    [](const Entry& e) { return e.state == State::failed; }))
      throw InputError(problems_);
    for (const auto& problem : problems_) fmt::print(stderr, "{}\n", problem);
    for (const auto& entry : entries_)
      if (entry.state == State::failed && entry.record.status == "failed" && options_.only.empty())
        write_case_record(entry.place.record, entry.record);
    const auto wanted = static_cast<double>(count(State::waiting));
    total_ = wanted;
    Progress progress(study_.title, std::max(1.0, wanted), options_.run.quiet());
    while (count(State::waiting) + count(State::running) > 0) {
      if (const int stop = stop_requested()) return end_all(stop);
      start_ready();
      reap();
      progress.update(done_part(), running_names());
      if (count(State::running) + count(State::waiting) > 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (wanted > 0) progress.finish();
    return worst_;
  }

 private:
  std::size_t count(State state) const {
    return static_cast<std::size_t>(
        std::count_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.state == state; }));
  }

  double done_part() const {
    double done = total_ - static_cast<double>(count(State::waiting) + count(State::running));
    for (const auto& entry : entries_)
      if (entry.state == State::running && entry.of->kind == StudyKind::run)
        done += part_done(entry.place.folder);
    return done;
  }

  std::string running_names() const {
    std::string names;
    for (const auto& entry : entries_)
      if (entry.state == State::running) names += (names.empty() ? "" : ", ") + entry.of->name;
    return names;
  }

  bool has_needs(const Entry& entry) const { return !entry.of->from.empty() || !entry.of->start.empty(); }

  /// Cases that depend on no other are read before the first runs, so that a mistake in the last is told now.
  void prepare_all() {
    for (auto& entry : entries_) {
      entry.record = read_case_record(entry.place.record);
      if (!options_.only.empty() && entry.of->name != options_.only) {
        entry.state = entry.record.status == "finished" ? State::finished : State::failed;
        continue;
      }
      if (has_needs(entry)) continue;
      if (const auto made = command(entry); made && is_kept(entry, *made)) entry.state = State::finished;
    }
  }

  std::optional<CaseCommand> command(Entry& entry) {
    try {
      return command_of(study_, *entry.of, folder_, threads_);
    } catch (const Error& error) {
      fail(entry, error.exit_code(), error.what());
      return {};
    }
  }

  bool is_same(const Entry& entry, const CaseCommand& made) const {
    return entry.record.identity == made.identity &&
           (options_.any_version || entry.record.version == this_version());
  }
  bool is_kept(const Entry& entry, const CaseCommand& made) const {
    return is_same(entry, made) && entry.record.status == "finished";
  }

  void supersede(const Entry& entry) {
    const std::string was = entry.record.identity.empty() ? "unknown" : entry.record.identity.substr(0, 8);
    fs::path to = folder_ / "superseded" / (entry.of->name + "-" + was);
    for (int k = 2; fs::exists(to); ++k)
      to = folder_ / "superseded" / fmt::format("{}-{}_{}", entry.of->name, was, k);
    fs::create_directories(to.parent_path());
    fs::rename(entry.place.folder, to);
    if (!options_.run.quiet())
      fmt::print(stderr,
                 "case {}: its scene, inputs or the version of the program have changed; runs anew, the "
                 "old results are in {}\n",
                 entry.of->name, to.string());
  }

  void fail(Entry& entry, int code, const std::string& message) {
    entry.state = State::failed;
    entry.record.status = "failed";
    entry.record.code = code;
    entry.record.message = message;
    std::stringstream lines(message);
    for (std::string line; std::getline(lines, line);) {
      const auto text = fmt::format("case {}: {}", entry.of->name, line);
      if (total_ < 0)
        problems_.push_back(text);
      else
        fmt::print(stderr, "{}\n", text);
    }
    worst_ = std::max(worst_, code);
  }

  /// -1: one that it needs has failed; 0: not yet; 1: all are there.
  int needs(const Entry& entry) const {
    std::vector<std::string> points = entry.of->from;
    if (!entry.of->start.empty()) points.push_back(entry.of->start);
    int ready = 1;
    for (const auto& other : entries_) {
      if (std::find(points.begin(), points.end(), other.of->point) == points.end()) continue;
      if (other.state == State::failed) return -1;
      if (other.state != State::finished) ready = 0;
    }
    return ready;
  }

  void start_ready() {
    for (auto& entry : entries_) {
      if (static_cast<int>(count(State::running)) >= jobs_) return;
      if (entry.state != State::waiting) continue;
      const int ready = needs(entry);
      if (ready < 0)
        fail(entry, exit_numerical_failure, "not run: a case it needs has failed or is not there");
      if (ready > 0) start(entry);
    }
  }

  void start(Entry& entry) {
    const int log = open_case_log(entry.place.log);
    if (log < 0) return;  // another process works at it: once more later
    entry.record = read_case_record(entry.place.record);
    const auto made = command(entry);
    if (!made || is_kept(entry, *made)) {
      if (made) entry.state = State::finished;
      ::close(log);
      return;
    }
    const bool left = fs::exists(entry.place.folder) && !fs::is_empty(entry.place.folder);
    if (left && !is_same(entry, *made)) supersede(entry);
    entry.record = {made->identity, this_version(), "running", "", 0, 0};
    write_case_record(entry.place.record, entry.record);
    if (entry.of->kind != StudyKind::run) fs::create_directories(entry.place.folder);
    entry.begin = Clock::now();
    entry.child = start_child(made->words, log);
    entry.state = State::running;
  }

  void reap() {
    for (auto& entry : entries_) {
      if (entry.state != State::running) continue;
      const int code = child_exit_code(entry.child);
      if (code < 0) continue;
      settle(entry, code);
    }
  }

  void settle(Entry& entry, int code) {
    entry.record.seconds = seconds_since(entry.begin);
    if (code == exit_ok) {
      entry.state = State::finished;
      entry.record.status = "finished";
      if (!options_.run.quiet())
        fmt::print(stderr, "case {}: finished in {:.3g} s\n", entry.of->name, entry.record.seconds);
    } else if (code == exit_wall_time || code == 128 + SIGTERM || code == 128 + SIGINT) {
      entry.state = State::failed;
      entry.record.status = "interrupted";
      worst_ = std::max(worst_, code);
    } else {
      fail(entry, code, last_lines(entry.place.log));
      if (code > 128) entry.record.message = fmt::format("killed by signal {}", code - 128);
    }
    entry.record.code = code;
    write_case_record(entry.place.record, entry.record);
  }

  int stop_requested() const {
    if (interrupt_signal()) return 128 + interrupt_signal();
    return seconds_since(begin_) >= options_.run.walltime_s ? exit_wall_time : 0;
  }

  /// Every case saves a checkpoint and stops.
  int end_all(int code) {
    for (const auto& entry : entries_)
      if (entry.state == State::running) kill(entry.child, SIGTERM);
    while (count(State::running) > 0) {
      reap();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    fmt::print(stderr, "{}: stopped, every case is saved; the same command goes on\n", study_.title);
    return code;
  }

  const Study& study_;
  const fs::path& folder_;
  const StudyOptions& options_;
  std::vector<Entry> entries_;
  std::vector<std::string> problems_;
  Clock::time_point begin_ = Clock::now();
  double total_ = -1;
  int jobs_ = 1, threads_ = 1, worst_ = exit_ok;
};

}  // namespace

int run_cases(const Study& study, const fs::path& folder, const StudyOptions& options) {
  return Queue(study, folder, options).run();
}

}  // namespace granrad
