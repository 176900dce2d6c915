#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/io/snapshot.h"
#include "fit/fitting/fit_report.h"
#include "fit/fitting/fit_table.h"
#include "fit/generate/curve_error.h"
#include "fit/generate/generate.h"
#include "fit/trace/view_factor_samples.h"
#include "fit/vfgen/check_table.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;

/// Traces a snapshot unless that file is there.
fs::path traced(const GenerateSettings& settings, const fs::path& snapshot, const fs::path& file) {
  if (fs::exists(file)) return file;
  const auto read = read_enclosure(snapshot, settings.flow.enclosure);
  const auto found = trace(read.enclosure, settings.trace, snapshot.filename().string());
  if (!found.check.failed.empty())
    throw NumericalError(fmt::format("{}: self-check failed: {}", snapshot.string(), found.check.failed));
  write_view_factors(file, found);
  return file;
}

/// Traced packings of every solid fraction; fewer when interrupted.
std::vector<fs::path> trace_packings(const GenerateSettings& settings, const fs::path& folder, bool quiet) {
  std::vector<fs::path> files;
  const double total = static_cast<double>(settings.solid_fractions.size()) * settings.count;
  Progress progress("tracing", total, quiet);
  for (const double fraction : settings.solid_fractions)
    for (int k = 1; k <= settings.count && !interrupt_signal(); ++k) {
      const auto file = folder / "traced" / (traced_name(settings, fraction, k) + ".h5");
      const auto snapshot = folder / "snapshots" / (snapshot_name(settings, fraction, k) + ".hdf");
      if (!fs::exists(file) && !fs::exists(snapshot))
        write_frame(snapshot, packed_bed(settings, fraction, k), {});
      files.push_back(traced(settings, snapshot, file));
      progress.update(static_cast<double>(files.size()), fmt::format("solid fraction {}", fraction));
    }
  progress.finish();
  return files;
}

/// Traced snapshots of one row of a flow, as many as its curve needs; empty when interrupted.
std::vector<fs::path> trace_row(const GenerateSettings& settings, const FlowRow& row, const fs::path& folder,
                                const std::function<void(const std::string&)>& say) {
  const FlowSettings& flow = settings.flow;
  for (auto count = static_cast<std::size_t>(flow.snapshots);; count += (count + 1) / 2) {
    count = std::min(count, static_cast<std::size_t>(flow.most_snapshots));
    std::vector<fs::path> files;
    const auto snapshots = take_snapshots(row, flow, count, settings.trace.threads, say);
    for (const auto& snapshot : snapshots) {
      if (interrupt_signal()) return {};
      files.push_back(
          traced(settings, snapshot, folder / "traced" / (traced_name(settings, snapshot) + ".h5")));
    }
    if (interrupt_signal()) return {};
    const double error = curve_error(files);
    say(fmt::format("{}: {} snapshots, sampling error of the curve {:.2g} % ({:.2g} % asked for)", row.name,
                    files.size(), 100 * error, 100 * flow.curve_error));
    const bool all_there_are = files.size() < count || count >= static_cast<std::size_t>(flow.most_snapshots);
    if (error <= flow.curve_error || all_there_are) return files;
  }
}

std::vector<fs::path> trace_flows(const GenerateSettings& settings, const fs::path& folder, bool quiet) {
  const auto rows = flow_rows(settings.flow, folder);
  std::vector<fs::path> files;
  Progress progress("flows", static_cast<double>(rows.size() + settings.flow.files.size()), quiet);
  double done = 0;
  const auto say = [&](const std::string& text) { progress.update(done, text); };
  for (const auto& row : rows) {
    if (interrupt_signal()) break;
    const auto some = trace_row(settings, row, folder, say);
    files.insert(files.end(), some.begin(), some.end());
    progress.update(++done, row.name);
  }
  for (const auto& snapshot : settings.flow.files) {
    if (interrupt_signal()) break;
    files.push_back(
        traced(settings, snapshot, folder / "traced" / (traced_name(settings, snapshot) + ".h5")));
    progress.update(++done, snapshot.filename().string());
  }
  progress.finish();
  return files;
}

std::string origin_of(const GenerateSettings& s) {
  if (s.flow.present()) {
    std::string names;
    for (const auto* list : {&s.flow.scenes, &s.flow.folders, &s.flow.files})
      for (const auto& path : *list) names += (names.empty() ? "" : ", ") + path.filename().string();
    return fmt::format("snapshots of flows one residence time apart, {} seeds: {}", s.flow.seeds, names);
  }
  return fmt::format(
      "equilibrated hard-sphere fluids, d = {:g} m, in a closed box of {:g} x {:g} x {:g} m, {} snapshots of each "
      "solid fraction, seed {}",
      s.diameter_m, s.size_m.x, s.size_m.y, s.size_m.z, s.count, s.seed);
}

void describe_table(const GenerateSettings& settings, const std::string& name, const FitOptions& options,
                    CorrelationTable& table) {
  table.title =
      settings.title + fmt::format(" ({})", name == "paper" ? "the paper's choices" : name + " form");
  table.name = name + ".toml";
  table.provenance = {
      {"source", origin_of(settings)},
      {"method",
       fmt::format(
           "{} with {:g} rays per particle; unweighted least squares over all pairs with d* < {:g}; F_pw on {}",
           to_string(settings.trace.method), settings.trace.rays, options.pp_cutoff,
           options.walls.empty() ? "the walls of the largest area"
                                 : fmt::format("all walls with h < {:g} d", options.pw_reach))},
      {"created_by", fmt::format("vfgen generate {} ({})", program_version(), program_git_sha())}};
}

/// What vfgen check finds, in a file beside the table; how many of them are problems.
std::size_t write_findings(const fs::path& file, const CorrelationTable& table) {
  std::string text;
  std::size_t problems = 0;
  for (const auto& finding : check_table(table)) {
    problems += finding.problem;
    text += fmt::format("{} {}\n", finding.problem ? "problem" : "note   ", finding.text);
  }
  write_text_file(file, text);
  return problems;
}

/// One table, its page and its findings for each fit.
void fit_all(const GenerateSettings& settings, const fs::path& folder, const std::vector<fs::path>& traced,
             bool quiet) {
  const auto files = look_at(traced);
  std::vector<double> fractions;
  for (const auto& file : files) fractions.push_back(file.solid_fraction);
  const auto groups = grouped_by_solid_fraction(fractions);
  for (const auto& [its_name, its_options] : settings.fits) {
    const std::string& name = its_name;
    const auto& options = its_options;  // captured below
    Progress progress("fitting " + name, 1, quiet);
    auto fit = fit_table(
        groups.size(), [&](std::size_t k) { return read_samples(files, groups[k], options.pp_cutoff); },
        options, [&](double part) { progress.update(part); });
    progress.finish();
    describe_table(settings, name, options, fit.table);
    const auto table = folder / (name + ".toml");
    write_correlation(table, fit.table);
    write_fit_report(folder / (name + ".html"), fit.table, fit.rows);
    const auto problems = write_findings(folder / (name + ".check.txt"), fit.table);
    if (!quiet)
      fmt::print("{}  ({})\n", table.string(),
                 problems == 0 ? "sound" : fmt::format("{} problems", problems));
  }
}

}  // namespace

int run_generate(const GenerateCommand& command, Verbosity verbosity) {
  const bool quiet = verbosity == Verbosity::quiet;
  auto settings = read_generate_settings(command.config);
  settings.trace.threads = command.threads;
  for (const char* part : {settings.flow.present() ? "runs" : "snapshots", "traced"}) {
    std::error_code failure;
    fs::create_directories(command.folder / part, failure);
    if (failure)
      throw IoError(
          fmt::format("{}: cannot be made ({})", (command.folder / part).string(), failure.message()));
  }
  const auto files = settings.flow.present() ? trace_flows(settings, command.folder, quiet)
                                             : trace_packings(settings, command.folder, quiet);
  if (interrupt_signal()) return exit_ok;  // run_program turns the signal into the exit code
  fit_all(settings, command.folder, files, quiet);
  return exit_ok;
}

}  // namespace granrad
