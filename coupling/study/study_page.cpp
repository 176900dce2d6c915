#include "coupling/study/study_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "coupling/results/profiles.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/history.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/io/snapshot.h"
#include "dem/page/html_report.h"

namespace granrad {

namespace {

constexpr int curve_points = 120, profile_slices = 25;

std::string of_key(const StudyRow& row, const std::string& key) {
  for (auto one = row.of->varied.rbegin(); one != row.of->varied.rend(); ++one)
    if (one->first == key) return one->second;
  return "";
}

/// particles.csv of a validation: the column at the last time, by source.
std::map<std::string, std::vector<double>> last_particle_values(const std::filesystem::path& file,
                                                                const std::string& column) {
  const CsvTable table = read_csv(file);
  const std::size_t source = table.column("source"), time = table.column("time_s"),
                    value = table.column(column);
  std::map<std::string, std::vector<double>> values;
  double last = 0;
  for (const auto& cells : table.rows) {
    const double t = cell_number(cells[time]);
    if (t > last) values.clear(), last = t;
    if (t == last) values[cells[source]].push_back(cell_number(cells[value]));
  }
  return values;
}

Series& series(Chart& chart, const std::string& label) {
  for (auto& one : chart.series)
    if (one.label == label) return one;
  chart.series.push_back({.label = label, .x = {}, .y = {}, .error = {}, .points = true});
  return chart.series.back();
}

void add_curve(Chart& chart, const std::string& label, const std::string& formula, double low, double high,
               bool log_x) {
  Series line{.label = label, .x = {}, .y = {}, .error = {}};
  for (int k = 0; k <= curve_points; ++k) {
    const double part = static_cast<double>(k) / curve_points;
    const double x = log_x ? low * std::pow(high / low, part) : low + part * (high - low);
    line.x.push_back(x);
    line.y.push_back(evaluate(formula, {{"x", {x, 0}}}).value);
  }
  chart.series.push_back(line);
}

std::pair<double, double> range_of(const Chart& chart) {
  double low = infinity, high = -low;
  for (const auto& one : chart.series)
    for (double x : one.x) low = std::min(low, x), high = std::max(high, x);
  return {low, high};
}

Chart empty_chart(const StudyFigure& figure) {
  return {.title = figure.title,
          .x_label = figure.x_label,
          .y_label = figure.y_label,
          .series = {},
          .log_x = figure.log_x,
          .log_y = figure.log_y};
}

/// Lines over time, of the first case of each point.
void add_history(HtmlReport& page, const StudyFigure& figure, const StudyOutcome& outcome) {
  Chart chart = empty_chart(figure);
  for (const auto& point : figure.history)
    for (const auto& row : outcome.rows) {
      if (row.of->point != point || row.finished == 0 || row.of->kind != StudyKind::run) continue;
      const auto history = read_history(outcome.folder / row.of->name / "history.csv");
      for (const auto& name : figure.y)
        if (history.count(name) && history.count(figure.x))
          chart.series.push_back({.label = figure.y.size() > 1 ? fmt::format("{}, {}", point, name) : point,
                                  .x = history.at(figure.x),
                                  .y = history.at(name),
                                  .error = {}});
    }
  if (!chart.series.empty()) page.chart(chart);
}

/// Slices of the box along z, of the last frame of the first case of each point.
void add_profiles(HtmlReport& page, const StudyFigure& figure, const StudyOutcome& outcome) {
  Chart chart{.title = figure.title, .x_label = figure.x_label, .y_label = figure.y_label};
  for (const auto& point : figure.profiles)
    for (const auto& row : outcome.rows) {
      if (row.of->point != point || row.finished == 0 || row.of->kind != StudyKind::run) continue;
      const auto frames = CaseFolder(outcome.folder / row.of->name).frames();
      if (frames.empty()) continue;
      const Bed bed = read_frame(frames.back().file).bed;
      const Profile slices = profile({bed}, bed.box, 2, profile_slices);
      for (const auto& name : figure.y)
        chart.series.push_back({.label = point,
                                .x = slices.position_m,
                                .y = name == "velocity_m_s"     ? slices.velocity_m_s
                                     : name == "solid_fraction" ? slices.solid_fraction
                                                                : slices.temperature_K,
                                .error = {}});
    }
  if (!chart.series.empty()) page.chart(chart);
}

/// Distributions over the particles at the last instant of a validation, by source.
void add_particles(HtmlReport& page, const StudyFigure& figure, const StudyOutcome& outcome) {
  for (const auto& point : figure.particles)
    for (const auto& row : outcome.rows) {
      const auto file = outcome.folder / row.of->name / "particles.csv";
      if (row.of->point != point || row.finished == 0 || !std::filesystem::exists(file)) continue;
      std::vector<std::pair<std::string, std::vector<double>>> samples;
      for (auto& [source, values] : last_particle_values(file, figure.x))
        samples.emplace_back(source, values);
      if (!samples.empty())
        page.histogram(fmt::format("{} ({})", figure.title, point), figure.x_label, samples);
    }
}

void add_figure(HtmlReport& page, const StudyFigure& figure, const StudyOutcome& outcome) {
  if (!figure.history.empty()) return add_history(page, figure, outcome);
  if (!figure.profiles.empty()) return add_profiles(page, figure, outcome);
  if (!figure.particles.empty()) return add_particles(page, figure, outcome);
  Chart chart = empty_chart(figure);
  for (const auto& row : outcome.rows) {
    const auto& groups = figure.groups;
    if (!groups.empty() && std::find(groups.begin(), groups.end(), row.of->group) == groups.end()) continue;
    const auto x = row.quantity.find(figure.x);
    if (x == row.quantity.end() || row.finished == 0) continue;
    for (const auto& name : figure.y) {
      const auto y = row.quantity.find(name);
      if (y == row.quantity.end() || !std::isfinite(y->second.value)) continue;
      std::string label = figure.y.size() > 1 ? name : "";
      if (groups.size() > 1) label += (label.empty() ? "" : ", ") + row.of->group;
      if (!figure.by.empty())
        label += fmt::format("{}{} = {}", label.empty() ? "" : ", ", figure.by, of_key(row, figure.by));
      auto& line = series(chart, label.empty() ? "this study" : label);
      line.x.push_back(x->second.value);
      line.y.push_back(y->second.value);
      line.error.push_back(std::isfinite(y->second.error) ? y->second.error : 0);
    }
  }
  if (chart.series.empty()) return;
  const auto [low, high] = range_of(chart);
  for (const auto& curve : figure.curves)
    add_curve(chart, curve.label, curve.formula, low, high, figure.log_x);
  page.chart(chart);
  if (!figure.text.empty()) page.paragraph(figure.text);
}

/// Varied keys that are numbers; of keys that always change together the first.
std::vector<std::string> independent_keys(const StudyOutcome& outcome) {
  std::vector<std::string> keys;
  std::set<std::vector<std::string>> seen;
  for (const auto& row : outcome.rows)
    for (const auto& [key, value] : row.of->varied) {
      if (!row.quantity.count(key) || std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      std::vector<std::string> column;
      for (const auto& other : outcome.rows) column.push_back(of_key(other, key));
      if (seen.insert(column).second) keys.push_back(key);
    }
  return keys;
}

bool is_there(const StudyOutcome& outcome, const std::string& name) {
  return std::any_of(outcome.rows.begin(), outcome.rows.end(), [&](const StudyRow& row) {
    const auto found = row.quantity.find(name);
    return found != row.quantity.end() && std::isfinite(found->second.value) && found->second.value != 0;
  });
}

/// Without figures of its own a study shows what people look for first against every key that is a number, a colour
/// for each value of another key.
std::vector<StudyFigure> usual_figures(const StudyOutcome& outcome) {
  std::vector<StudyFigure> all;
  const auto keys = independent_keys(outcome);
  for (const auto& key : keys) {
    StudyFigure figure;
    figure.title = "Wall-to-particle coefficients against " + key;
    figure.x = figure.x_label = key;
    figure.y_label = "h, W/(m² K)";
    for (const auto& other : keys)
      if (other != key && figure.by.empty()) figure.by = other;
    for (const char* name : {"h_wp_W_m2K", "h_ss_W_m2K", "h_sfs_W_m2K", "h_rad_W_m2K"})
      if (is_there(outcome, name) && (figure.by.empty() || figure.y.empty())) figure.y.push_back(name);
    if (!figure.y.empty()) all.push_back(figure);
  }
  return all;
}

/// The lowest and the highest of a quantity.
void add_range(std::vector<Tile>& tiles, const StudyOutcome& outcome, const std::string& name,
               const std::string& label, const std::string& unit) {
  const StudyRow *low = nullptr, *high = nullptr;
  const auto value = [&](const StudyRow* row) { return row->quantity.at(name).value; };
  for (const auto& row : outcome.rows) {
    if (!row.quantity.count(name) || !std::isfinite(value(&row))) continue;
    if (!low || value(&row) < value(low)) low = &row;
    if (!high || value(&row) > value(high)) high = &row;
  }
  if (!low || value(high) == 0) return;
  for (const StudyRow* row : {high, low}) {
    const auto& measured = row->quantity.at(name);
    tiles.push_back(
        tile(fmt::format("{} {}, of {}", row == high ? "highest" : "lowest", label, row->of->point), unit,
             measured.value, measured.error));
    if (high == low) break;
  }
}

void add_head(HtmlReport& page, const StudyOutcome& outcome) {
  double seconds = 0;
  std::size_t finished = 0, agree = 0, judged = 0;
  for (const auto& row : outcome.rows) seconds += row.seconds, finished += row.status() == "finished";
  for (const auto& j : outcome.judged) agree += j.verdict == "agrees", judged += j.verdict == "differs";
  judged += agree;
  page.verdict(
      fmt::format("{} of {} points finished, {:.0f} s of computing.{}", finished, outcome.rows.size(),
                  seconds, judged ? fmt::format(" {} of {} numbers of others agree.", agree, judged) : ""),
      finished == outcome.rows.size());
  std::vector<Tile> tiles;
  add_range(tiles, outcome, "h_wp_W_m2K", "wall-to-particle coefficient", "W/m²K");
  add_range(tiles, outcome, "k_W_mK", "conductivity", "W/(m K)");
  if (!tiles.empty()) page.tiles(tiles);
  page.paragraph(
      "Errors are standard errors: of the scatter between seeds where there are several, else of batches in time.");
}

void add_claims(HtmlReport& page, const StudyOutcome& outcome) {
  if (outcome.judged.empty()) return;
  std::size_t agree = 0, differ = 0, not_possible = 0, told = 0;
  std::vector<std::vector<std::string>> rows;
  for (const auto& j : outcome.judged) {
    agree += j.verdict == "agrees";
    differ += j.verdict == "differs";
    not_possible += j.verdict.starts_with("not reproducible");
    told += j.verdict == "told";
    rows.push_back(
        {j.claim.id, j.claim.quantity, j.claim.place, j.claim.text,
         std::isfinite(j.claim.reference) ? with_error({j.claim.reference, j.claim.uncertainty}) : "",
         with_error(j.ours), j.claim.unit,
         std::isfinite(j.difference_pct) ? fmt::format("{:+.1f} %", j.difference_pct) : "", j.verdict,
         j.verdict == "agrees" ? "" : j.claim.why});
  }
  page.heading("Every number beside ours");
  std::string text = fmt::format("{} numbers: {} agree, {} differ", rows.size(), agree, differ);
  if (not_possible > 0) text += fmt::format(", {} cannot be reproduced as stated", not_possible);
  if (told > 0) text += fmt::format(", {} are told beside a statement without a number", told);
  page.paragraph(text + ".");
  page.filtered_table(
      {"number", "quantity", "place", "claim", "reference", "ours", "unit", "difference", "verdict", "why"},
      rows, {8, 1, 2});
}

void add_fits(HtmlReport& page, const StudyOutcome& outcome) {
  if (outcome.curves.empty()) return;
  std::vector<std::vector<std::string>> rows;
  for (const auto& curve : outcome.curves) {
    std::string coefficients;
    for (const auto& [name, c] : curve.coefficient)
      if (name != "R2")
        coefficients += fmt::format("{}{} = {}", coefficients.empty() ? "" : ", ", name, with_error(c));
    const auto r2 = curve.coefficient.find("R2");
    rows.push_back({curve.of.name, curve.of.y, curve.problem.empty() ? curve.formula : curve.problem,
                    coefficients,
                    r2 == curve.coefficient.end() ? "" : fmt::format("{:.4f}", r2->second.value),
                    fmt::format("{}", curve.points)});
  }
  page.heading("Fitted curves");
  page.table({"fit", "of", "formula of x", "coefficients", "R²", "points"}, rows);
}

void add_points(HtmlReport& page, const StudyOutcome& outcome) {
  page.heading("Every case");
  std::vector<std::string> names;
  for (const char* name : {"h_wp_W_m2K", "Nu_d", "share_rad_pct", "mean_temperature_K", "solid_fraction"})
    if (is_there(outcome, name)) names.push_back(name);
  std::vector<std::string> header = {"case", "status", "seeds"};
  header.insert(header.end(), names.begin(), names.end());
  header.push_back("seconds");
  std::vector<std::vector<std::string>> table;
  for (const auto& row : outcome.rows) {
    std::vector<std::string> line = {row.of->point, row.status(), fmt::format("{}", row.finished)};
    for (const auto& name : names) {
      const auto found = row.quantity.find(name);
      line.push_back(found == row.quantity.end() ? "" : with_error(found->second));
    }
    line.push_back(fmt::format("{:.3g}", row.seconds));
    table.push_back(line);
  }
  page.table(header, table);
  for (const auto& row : outcome.rows) {
    std::set<std::string> told;  // replicates fail alike
    for (const auto& record : row.records)
      if (record.status == "failed" && told.insert(record.message).second)
        page.paragraph(fmt::format("{} failed: {}", row.of->point, record.message));
  }
}

}  // namespace

void write_study_page(const std::filesystem::path& file, const StudyOutcome& outcome) {
  HtmlReport page(outcome.study.title);
  add_head(page, outcome);
  const auto figures = outcome.study.figures.empty() ? usual_figures(outcome) : outcome.study.figures;
  for (const auto& figure : figures) add_figure(page, figure, outcome);
  add_claims(page, outcome);
  add_fits(page, outcome);
  add_points(page, outcome);
  page.provenance_of_this_process();
  page.write(file);
}

}  // namespace granrad
