#include "fit/fitting/fit_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/stated_number.h"
#include "dem/page/html_report.h"
#include "raytrace/exact.h"

namespace granrad {

namespace {

std::string with_error(double value, const std::vector<double>& errors, std::size_t k) {
  return k < errors.size() ? stated(value, errors[k]).text() : fmt::format("{:.5g}", value);
}

/// What the table came to: its worst row.
void add_head(HtmlReport& report, const std::vector<RowFit>& rows) {
  double pp = 0, pw = 0, held_out = 0, closure = 0;
  std::size_t snapshots = 0, fewest = rows.empty() ? 0 : rows.front().origins.size();
  for (const auto& row : rows) {
    pp = std::max(pp, row.pp.rmse);
    pw = std::max(pw, row.pw.rmse);
    held_out = std::max(held_out, row.pp.held_out_rmse);
    if (std::abs(row.row.statistics.closure_mean) > std::abs(closure))
      closure = row.row.statistics.closure_mean;
    snapshots += row.origins.size();
    fewest = std::min(fewest, row.origins.size());
  }
  report.verdict(fewest < 2 ? "A row was made of one snapshot: the errors of its coefficients are too small."
                            : fmt::format("{} solid fractions from {} snapshots, {} or more each.",
                                          rows.size(), snapshots, fewest),
                 fewest >= 2);
  std::vector<Tile> tiles = {{"rms of fit minus traced F, pairs, worst row", fmt::format("{:.2e}", pp)},
                             {"the same, particle to wall", fmt::format("{:.2e}", pw)},
                             {"row sums minus 1, worst row", fmt::format("{:+.2g}", 100 * closure), "", "%"}};
  if (held_out > 0)
    tiles.insert(tiles.begin() + 1, {"on snapshots held out, pairs", fmt::format("{:.2e}", held_out)});
  report.tiles(tiles);
}

void coefficient_table(HtmlReport& report, const std::vector<RowFit>& rows, bool walls,
                       CorrelationForm form) {
  std::vector<std::string> header = {"solid fraction"};
  const auto names = coefficient_names(form, walls ? Partner::wall : Partner::sphere);
  header.insert(header.end(), names.begin(), names.end());
  std::vector<std::vector<std::string>> lines;
  for (const auto& row : rows) {
    const auto& fit = walls ? row.pw : row.pp;
    auto& line = lines.emplace_back(1, fmt::format("{:.4f}", row.row.solid_fraction));
    for (std::size_t k = 0; k < fit.coefficient.size(); ++k)
      line.push_back(with_error(fit.coefficient[k], fit.standard_error, k));
  }
  report.table(header, lines);
}

void statistics_table(HtmlReport& report, const std::vector<RowFit>& rows, bool walls) {
  std::vector<std::vector<std::string>> lines;
  for (const auto& row : rows) {
    const auto& fit = walls ? row.pw : row.pp;
    lines.push_back({fmt::format("{:.4f}", row.row.solid_fraction), fmt::format("{}", row.origins.size()),
                     fmt::format("{:.0f}", fit.samples), fmt::format("{:.3e}", fit.rmse),
                     fmt::format("{:.3e}", fit.ray_noise), fmt::format("{:.3e}", fit.scatter),
                     fit.held_out_rmse > 0 ? fmt::format("{:.3e}", fit.held_out_rmse) : "one snapshot",
                     fit.left_out_rmse > 0 ? fmt::format("{:.3e}", fit.left_out_rmse) : "end row"});
  }
  report.table({"solid fraction", "snapshots", "samples", "RMSE", "of it ray noise",
                "scatter at one distance", "RMSE on snapshots held out", "RMSE without this row"},
               lines);
}

constexpr double smallest_on_log_axis = 1e-7;  ///< below, a view factor is nothing

Series series_of(const RowFit& row, const char* what, int colour) {
  Series series;
  series.label = fmt::format("{}, {:.3f}", what, row.row.solid_fraction);
  series.colour = colour;
  return series;
}

/// Traced means with the curve through them, one colour a solid fraction.
Chart curves(const std::vector<RowFit>& rows, bool walls, bool logarithmic) {
  Chart chart{.title = fmt::format("{}{}", walls ? "Particle to wall" : "Particle to particle",
                                   logarithmic ? ", logarithmic" : ""),
              .x_label = walls ? "h / d, centre to plane over diameter" : "d*, centre distance over diameter",
              .y_label = walls ? "F_pw" : "F_pp",
              .series = {},
              .log_x = logarithmic,
              .log_y = logarithmic};
  int colour = 0;
  for (const auto& row : rows) {
    const auto& fit = walls ? row.pw : row.pp;
    Series traced = series_of(row, "traced", colour++);
    traced.points = true;
    for (const auto& bin : fit.bins) {
      if (logarithmic && bin.mean < smallest_on_log_axis) continue;
      traced.x.push_back(bin.distance);
      traced.y.push_back(bin.mean);
      traced.error.push_back(bin.mean_error);
    }
    chart.series.push_back(traced);
  }
  colour = 0;
  for (const auto& row : rows) {
    const auto& fit = walls ? row.pw : row.pp;
    Series line = series_of(row, "fit", colour++);
    for (const auto& bin : fit.bins) {
      if (logarithmic && bin.fitted < smallest_on_log_axis) continue;
      line.x.push_back(bin.distance);
      line.y.push_back(bin.fitted);
    }
    chart.series.push_back(line);
  }
  return chart;
}

/// What the curve misses in the mean, and the scatter no curve can remove.
Chart residuals(const RowFit& row, bool walls) {
  const auto& fit = walls ? row.pw : row.pp;
  Chart chart{.title = fmt::format("{} at solid fraction {:.3f}: traced mean minus fit, and scatter",
                                   walls ? "F_pw" : "F_pp", row.row.solid_fraction),
              .x_label = walls ? "h / d" : "d*",
              .y_label = walls ? "difference in F_pw" : "difference in F_pp",
              .series = {}};
  Series mean{
      .label = "traced mean − fit, one standard error", .x = {}, .y = {}, .error = {}, .points = true};
  Series scatter{
      .label = "scatter of single values, one sigma, without noise", .x = {}, .y = {}, .error = {}};
  for (const auto& bin : fit.bins) {
    if (bin.count < 2) continue;
    mean.x.push_back(bin.distance);
    mean.y.push_back(bin.mean - bin.fitted);
    mean.error.push_back(bin.mean_error);
    scatter.x.push_back(bin.distance);
    scatter.y.push_back(std::sqrt(std::max(0.0, bin.scatter2)));
  }
  chart.series = {mean, scatter};
  return chart;
}

void closure_table(HtmlReport& report, const std::vector<RowFit>& rows) {
  std::vector<std::vector<std::string>> lines;
  for (const auto& row : rows)
    lines.push_back({fmt::format("{:.4f}", row.row.solid_fraction),
                     fmt::format("{:+.4f}", row.row.statistics.closure_mean),
                     fmt::format("{:.4f}", row.row.statistics.closure_rms)});
  report.table({"solid fraction", "mean of row sum − 1", "rms"}, lines);
}

}  // namespace

void write_fit_report(const std::filesystem::path& file, const CorrelationTable& table,
                      const std::vector<RowFit>& rows) {
  HtmlReport report(table.title.empty() ? "View factor correlation" : table.title);
  add_head(report, rows);
  report.paragraph(describe(table.form) +
                   ". Unweighted least squares over all pairs, invisible ones included.");
  report.paragraph(
      "Errors of coefficients: ± the standard error by the scatter between snapshots, widened by Student's t so "
      "that ± 1.96 of them cover 95 %; with one snapshot pairs are taken as independent, which they are not. "
      "RMSE without this row: of the table interpolated between its neighbours.");
  for (const bool walls : {false, true}) {
    report.heading(walls ? "Particle to wall" : "Particle to particle");
    coefficient_table(report, rows, walls, table.form);
    statistics_table(report, rows, walls);
    report.chart(curves(rows, walls, false));
    if (!walls) report.chart(curves(rows, walls, true));
    for (const auto& row : rows) report.chart(residuals(row, walls));
  }
  report.heading("Closure");
  report.paragraph(
      "Row sums of the particles with this table on the snapshots it was fitted to, before any closing.");
  closure_table(report, rows);
  report.provenance_of_this_process();
  report.write(file);
}

}  // namespace granrad
