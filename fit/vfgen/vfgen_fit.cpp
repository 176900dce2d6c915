#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/base/stated_number.h"
#include "fit/fitting/fit_report.h"
#include "fit/fitting/fit_table.h"
#include "fit/trace/view_factor_samples.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

std::string joined(const std::vector<std::filesystem::path>& files) {
  std::string all;
  for (const auto& file : files) all += (all.empty() ? "" : ", ") + file.filename().string();
  return all;
}

void print_rows(const std::vector<RowFit>& rows) {
  fmt::print("fraction  beds {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6}\n", "pp RMSE", "scatter", "held out",
             "left out", "pw RMSE", "scatter", "row-1");
  const auto known = [](double rmse) { return rmse > 0 ? fmt::format("{:.2e}", rmse) : std::string("-"); };
  for (const auto& row : rows)
    fmt::print("{:8.4f} {:5} {:8.2e} {:8.2e} {:>8} {:>8} {:8.2e} {:8.2e} {:+6.3f}\n", row.row.solid_fraction,
               row.origins.size(), row.pp.rmse, row.pp.scatter, known(row.pp.held_out_rmse),
               known(row.pp.left_out_rmse), row.pw.rmse, row.pw.scatter, row.row.statistics.closure_mean);
}

/// Verbose: every coefficient with its error.
void print_coefficients(const CorrelationTable& table) {
  for (const auto& row : table.rows)
    for (const auto partner : {Partner::sphere, Partner::wall}) {
      const bool pairs = partner == Partner::sphere;
      const auto names = coefficient_names(table.form, partner);
      const auto& value = pairs ? row.pp : row.pw;
      const auto& error = pairs ? row.statistics.pp_standard_error : row.statistics.pw_standard_error;
      std::string line = fmt::format("  {:.4f} {}", row.solid_fraction, pairs ? "pp" : "pw");
      for (std::size_t k = 0; k < names.size(); ++k)
        line += fmt::format("  {} = {}", names[k], stated(value[k], error[k]).text(" +- "));
      fmt::print("{}\n", line);
    }
}

void describe_table(const FitCommand& command, CorrelationTable& table) {
  const FitOptions& options = command.options;
  table.title = fmt::format("View factors of a bed of equal spheres, {} form", to_string(options.form));
  table.name = command.output.string();
  const std::string walls = options.walls.empty()       ? "the largest walls"
                            : options.walls[0] == "all" ? "all walls"
                                                        : "chosen walls";
  const std::string reach =
      options.pw_reach < largest_pw_cutoff ? fmt::format(" with h < {:g} d", options.pw_reach) : "";
  table.provenance = {
      {"method", fmt::format("unweighted least squares over {} pairs with d* < {:g}; F_pw on {}{}",
                             options.visible_only ? "visible" : "all", options.pp_cutoff, walls, reach)},
      {"inputs", joined(command.files)},
      {"created_by", fmt::format("vfgen {} ({})", program_version(), program_git_sha())}};
}

}  // namespace

int run_fit(const FitCommand& command, Verbosity verbosity) {
  const auto files = look_at(command.files);
  std::vector<double> fractions;
  for (const auto& file : files) fractions.push_back(file.solid_fraction);
  const auto groups = grouped_by_solid_fraction(fractions);
  Progress progress("fitting", 1, verbosity == Verbosity::quiet || files.size() == 1);
  auto fit = fit_table(
      groups.size(), [&](std::size_t k) { return read_samples(files, groups[k], command.options.pp_cutoff); },
      command.options, [&](double part) { progress.update(part); });
  progress.finish();
  describe_table(command, fit.table);
  write_correlation(command.output, fit.table);
  if (!command.report.empty()) write_fit_report(command.report, fit.table, fit.rows);
  for (const auto& row : fit.rows)
    if (const auto warning = snapshot_warning(row.row.solid_fraction, row.origins.size()); !warning.empty())
      print_message(fmt::format("warning: {}", warning));
  if (verbosity == Verbosity::quiet) return exit_ok;
  print_rows(fit.rows);
  if (verbosity == Verbosity::verbose) print_coefficients(fit.table);
  fmt::print("{}{}\n", command.output.string(),
             command.report.empty() ? "" : fmt::format(", report in {}", command.report.string()));
  return exit_ok;
}

}  // namespace granrad
