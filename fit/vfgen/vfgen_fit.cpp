#include <fmt/core.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "fit/fitting/fit_report.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

std::vector<SampleSet> read_samples(const FitCommand& command, bool quiet) {
  std::vector<SampleSet> samples;
  Progress progress("reading", static_cast<double>(command.files.size()), quiet || command.files.size() == 1);
  for (const auto& file : command.files) {
    const auto traced = read_view_factors(file);
    if (std::any_of(traced.emissivity.begin(), traced.emissivity.end(), [](double e) { return e != 1; }))
      throw InputError(
          fmt::format("{}: holds total exchange areas of grey surfaces (a table is fitted to view "
                      "factors) trace without --emissivity",
                      file.string()));
    samples.push_back(
        make_samples(traced.enclosure, traced.counts, command.options.pp_cutoff, file.string()));
    progress.update(static_cast<double>(samples.size()));
  }
  return samples;
}

std::string joined(const std::vector<std::filesystem::path>& files) {
  std::string all;
  for (const auto& file : files) all += (all.empty() ? "" : ", ") + file.filename().string();
  return all;
}

}  // namespace

int run_fit(const FitCommand& command, Verbosity verbosity) {
  const auto groups = grouped_by_solid_fraction(read_samples(command, verbosity == Verbosity::quiet));
  std::vector<RowFit> rows;
  if (verbosity != Verbosity::quiet)
    fmt::print("{:>14} {:>9} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "solid fraction", "snapshots",
               "pp RMSE", "scatter", "held out", "pw RMSE", "scatter", "row sum-1");
  for (const auto& group : groups) {
    rows.push_back(fit_row(group, command.options));
    const auto& row = rows.back();
    if (verbosity != Verbosity::quiet)
      fmt::print("{:14.4f} {:9} {:10.3e} {:10.3e} {:10.3e} {:10.3e} {:10.3e} {:+10.4f}\n",
                 row.row.solid_fraction, group.size(), row.pp.rmse, row.pp.scatter, row.pp.held_out_rmse,
                 row.pw.rmse, row.pw.scatter, row.row.statistics.closure_mean);
  }
  auto table = make_table(rows, command.options);
  table.title =
      fmt::format("View factors of a bed of equal spheres, {} form", to_string(command.options.form));
  table.name = command.output.string();
  table.provenance = {
      {"method", fmt::format("unweighted least squares over {} pairs with d* < {:g}",
                             command.options.visible_only ? "visible" : "all", command.options.pp_cutoff)},
      {"inputs", joined(command.files)},
      {"created_by", fmt::format("vfgen {} ({})", program_version(), program_git_sha())}};
  write_correlation(command.output, table);
  if (!command.report.empty()) write_fit_report(command.report, table, rows);
  if (verbosity != Verbosity::quiet)
    fmt::print("{}{}\n", command.output.string(),
               command.report.empty() ? "" : fmt::format(", report in {}", command.report.string()));
  return exit_ok;
}

}  // namespace granrad
