#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/io/snapshot.h"
#include "fit/fitting/fit_report.h"
#include "fit/vfgen/generate.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

/// The traced snapshot, from the folder if it is there. Empty when interrupted.
std::filesystem::path traced_file(const GenerateSettings& settings, const std::filesystem::path& folder,
                                  double solid_fraction, int number) {
  const auto file = folder / "traced" / (traced_name(settings, solid_fraction, number) + ".h5");
  if (std::filesystem::exists(file)) return file;
  const auto snapshot = folder / "snapshots" / (snapshot_name(settings, solid_fraction, number) + ".hdf");
  if (!std::filesystem::exists(snapshot))
    write_frame(snapshot, packed_bed(settings, solid_fraction, number), {});
  const auto traced =
      trace(read_enclosure(snapshot, {}).enclosure, settings.trace, snapshot.filename().string());
  if (!traced.check.failed.empty())
    throw NumericalError(fmt::format("{}: self-check failed: {}", snapshot.string(), traced.check.failed));
  write_view_factors(file, traced);
  return file;
}

/// Every snapshot's traced file, by solid fraction; fewer when interrupted.
std::vector<std::vector<std::filesystem::path>> trace_all(const GenerateSettings& settings,
                                                          const std::filesystem::path& folder, bool quiet) {
  std::vector<std::vector<std::filesystem::path>> files;
  const double total = static_cast<double>(settings.solid_fractions.size()) * settings.count;
  Progress progress("tracing", total, quiet);
  double done = 0;
  for (const double fraction : settings.solid_fractions) {
    auto& of_fraction = files.emplace_back();
    for (int k = 1; k <= settings.count && !interrupt_signal(); ++k) {
      of_fraction.push_back(traced_file(settings, folder, fraction, k));
      progress.update(++done, fmt::format("solid fraction {}", fraction));
    }
  }
  progress.finish();
  return files;
}

/// One table and its report.
void fit_all(const GenerateSettings& settings, const std::filesystem::path& folder,
             const std::vector<std::vector<std::filesystem::path>>& files, bool quiet) {
  std::vector<FitOptions> options;
  std::vector<std::vector<RowFit>> rows(settings.forms.size());
  for (const auto form : settings.forms)
    options.push_back({.form = form, .pp_cutoff = settings.cutoff, .walls = {}});
  Progress progress("fitting", static_cast<double>(files.size()), quiet);
  for (std::size_t f = 0; f < files.size(); ++f) {
    std::vector<SampleSet> samples;
    for (const auto& file : files[f]) {
      const auto traced = read_view_factors(file);
      samples.push_back(
          make_samples(traced.enclosure, traced.counts, settings.cutoff, file.filename().string()));
    }
    for (std::size_t k = 0; k < options.size(); ++k) rows[k].push_back(fit_row(samples, options[k]));
    progress.update(static_cast<double>(f + 1));
  }
  progress.finish();
  for (std::size_t k = 0; k < options.size(); ++k) {
    auto table = make_table(rows[k], options[k]);
    table.title = settings.title + fmt::format(" ({} form)", to_string(options[k].form));
    table.provenance = {
        {"source",
         fmt::format(
             "equilibrated hard-sphere fluids, d = {:g} m, in a closed box of {:g} x {:g} x {:g} m, {} "
             "snapshots of each solid fraction, seed {}",
             settings.diameter_m, settings.size_m.x, settings.size_m.y, settings.size_m.z, settings.count,
             settings.seed)},
        {"method",
         fmt::format(
             "{} with {:g} rays per particle; unweighted least squares over all pairs with d* < {:g}; "
             "F_pw on the walls of the largest area",
             to_string(settings.trace.method), settings.trace.rays, settings.cutoff)},
        {"created_by", fmt::format("vfgen generate {} ({})", program_version(), program_git_sha())}};
    const std::string name = to_string(options[k].form);
    write_correlation(folder / (name + ".toml"), table);
    write_fit_report(folder / (name + ".html"), table, rows[k]);
    if (!quiet) fmt::print("{}\n", (folder / (name + ".toml")).string());
  }
}

}  // namespace

int run_generate(const GenerateCommand& command, Verbosity verbosity) {
  auto settings = read_generate_settings(command.config);
  settings.trace.threads = command.threads;
  for (const char* part : {"snapshots", "traced"}) {
    std::error_code failure;
    std::filesystem::create_directories(command.folder / part, failure);
    if (failure)
      throw IoError(
          fmt::format("{}: cannot be made ({})", (command.folder / part).string(), failure.message()));
  }
  const auto files = trace_all(settings, command.folder, verbosity == Verbosity::quiet);
  if (interrupt_signal()) return exit_ok;  // run_program turns the signal into the exit code
  fit_all(settings, command.folder, files, verbosity == Verbosity::quiet);
  return exit_ok;
}

}  // namespace granrad
