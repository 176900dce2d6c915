#include <fmt/core.h>

#include <functional>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/program.h"
#include "dem/ranks/ranks.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

/// FILE.h5, or FILE_0003.h5 for the third of several.
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number, std::size_t count) {
  if (count == 1) return file;
  auto name = file;
  name.replace_filename(fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string()));
  return name;
}

struct Job {
  std::filesystem::path file;
  SnapshotChoice which;
};

/// One job a file, or one a snapshot of each with --step all.
std::vector<Job> snapshots_to_trace(const TraceCommand& command) {
  std::vector<Job> jobs;
  for (const auto& file : command.snapshots) {
    if (!command.every_step) {
      jobs.push_back({file, command.enclosure.which});
      continue;
    }
    const SnapshotFile all(file, command.enclosure.radius_m);
    for (const std::int64_t step : all.steps()) jobs.push_back({file, {SnapshotChoice::Kind::step, step}});
  }
  return jobs;
}

/// What would end a command after hours of tracing, found before: throws IoError.
void require_files(const TraceCommand& command) {
  std::string missing;
  for (const auto& snapshot : command.snapshots)
    if (!std::filesystem::exists(snapshot))
      missing += fmt::format("{}{}: there is no such file", missing.empty() ? "" : "\n", snapshot.string());
  if (!missing.empty()) throw IoError(missing);
  std::error_code failure;  // the writer says what cannot be made
  if (command.output.has_parent_path())
    std::filesystem::create_directories(command.output.parent_path(), failure);
  const Hdf5Writer writable(command.output);
}

/// Shows how far a trace is, each round from the start, and stops it at a signal.
class ShownTrace {
 public:
  ShownTrace(std::string what, bool quiet) : what_(std::move(what)), quiet_(quiet) {}
  bool operator()(double part) {
    if (!progress_ || part < part_)
      progress_.emplace(fmt::format("{}, round {}", what_, ++round_), 1.0, quiet_);
    part_ = part;
    progress_->update(part);
    return interrupt_signal() == 0;
  }

 private:
  std::string what_;
  bool quiet_;
  int round_ = 0;
  double part_ = 0;
  std::optional<Progress> progress_;
};

ViewFactorFile trace_shown(const Enclosure& enclosure, TraceSettings settings, const std::string& snapshot,
                           bool quiet) {
  ShownTrace shown("tracing " + snapshot, quiet);
  settings.watch = std::ref(shown);
  return trace(enclosure, settings, snapshot);
}

/// Every snapshot, read before the first is traced: what is wrong with any is said at once.
std::vector<SnapshotEnclosure> read_all(const TraceCommand& command, const std::vector<Job>& jobs) {
  std::vector<SnapshotEnclosure> all;
  std::vector<std::string> problems;
  for (const auto& job : jobs) try {
      EnclosureSettings settings = command.enclosure;
      settings.which = job.which;
      all.push_back(read_enclosure(job.file, settings));
      require_traceable(all.back().enclosure, command.trace, job.file.string());
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  if (!problems.empty()) throw InputError(problems);
  return all;
}

/// What a user should know of a snapshot before it is traced.
void remark_on(const std::string& snapshot, const SnapshotEnclosure& read, Verbosity verbosity) {
  if (!read.note.empty()) print_message(fmt::format("note: {}", read.note));
  if (read.left_out > 0)
    fmt::print(stderr, "{}: {} particles with their centre outside the box were left out\n", snapshot,
               read.left_out);
  if (!read.overlaps.empty()) print_message(read.overlaps);
  if (!read.meshes.empty() && verbosity != Verbosity::quiet) print_message(read.meshes);
}

void print_traced(const std::filesystem::path& file, const ViewFactorFile& traced, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  fmt::print("{}: {} spheres, {} walls; {}\n  {}\n", file.string(), traced.enclosure.sphere_count(),
             traced.enclosure.walls.size(), self_check_line(traced.check), spent_line(traced));
  if (verbosity != Verbosity::verbose) return;
  const auto entries = traced.closed.value.size();
  fmt::print(
      "  method {}, sampling {}, seed {}; solid fraction {}; {} view factors; largest correction of a row by "
      "closure {:.2g}\n",
      traced.method, traced.sampling, traced.seed,
      traced.enclosure.solid_fraction > 0 ? fmt::format("{:.4f}", traced.enclosure.solid_fraction)
                                          : "not known",
      entries, traced.closure_correction_max);
}

}  // namespace

int run_trace(const TraceCommand& command, Verbosity verbosity) {
  if (command.output.extension() != ".h5")
    throw InputError(advised(fmt::format("--output: {} (view factors are HDF5)", command.output.string()),
                             "name it FILE.h5"));
  on_first_rank([&] { require_files(command); });
  const auto jobs = snapshots_to_trace(command);
  const auto snapshots = read_all(command, jobs);
  std::string failures;
  for (std::size_t k = 0; k < jobs.size() && !largest_over_ranks(interrupt_signal()); ++k) {
    const std::string snapshot = jobs[k].file.string();
    remark_on(snapshot, snapshots[k], verbosity);
    const auto traced =
        trace_shown(snapshots[k].enclosure, command.trace, snapshot, verbosity == Verbosity::quiet);
    const auto file = numbered(command.output, k + 1, jobs.size());
    on_first_rank([&] { write_view_factors(file, traced); });
    print_traced(file, traced, verbosity);
    if (!traced.check.failed.empty()) failures += fmt::format("\n{}: {}", file.string(), traced.check.failed);
  }
  if (!failures.empty()) throw NumericalError("self-check failed:" + failures);
  return exit_ok;
}

}  // namespace granrad
