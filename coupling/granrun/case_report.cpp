#include "coupling/granrun/case_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "coupling/granrun/render.h"
#include "coupling/granrun/run_record.h"
#include "coupling/results/profiles.h"
#include "coupling/results/results.h"
#include "coupling/results/written_units.h"
#include "coupling/simulation/case_folder.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/stated_number.h"
#include "dem/io/snapshot.h"
#include "dem/page/html_report.h"

namespace granrad {

namespace {

constexpr std::size_t frames_in_profiles = 10;

/// Finite points of a column.
Series series(const std::string& label, const History& history, const std::string& column) {
  Series result{label, {}, {}, {}, false};
  const auto found = history.find(column);
  if (found == history.end()) return result;
  const auto& time = history.at("time_s");
  for (std::size_t k = 0; k < time.size(); ++k)
    if (std::isfinite(found->second[k])) {
      result.x.push_back(time[k]);
      result.y.push_back(found->second[k]);
    }
  return result;
}

/// The same with one standard error of each value, where another column has it.
Series series(const std::string& label, const History& history, const std::string& column,
              const std::string& error_column) {
  Series result = series(label, history, column);
  const auto errors = history.find(error_column), values = history.find(column);
  if (errors == history.end() || values == history.end()) return result;
  for (std::size_t k = 0; k < values->second.size(); ++k)
    if (std::isfinite(values->second[k])) result.error.push_back(errors->second[k]);
  return result;
}

void add_chart(HtmlReport& page, const std::string& title, const std::string& y_label, const Results& results,
               std::vector<Series> all, std::size_t least = 1) {
  std::erase_if(all, [](const Series& s) {
    return s.y.empty() || std::all_of(s.y.begin(), s.y.end(), [](double y) { return y == 0; });
  });
  if (all.size() >= least)
    page.chart({title, "time, s", y_label, all, false, false, std::pair{results.from_s, results.to_s}});
}

void add_histories(HtmlReport& page, const History& h, const Results& r) {
  page.heading("Histories");
  page.paragraph("Shaded: the time that means are taken over. Bands: one standard error of the ray tracing.");
  add_chart(page, "Wall-to-particle coefficients", "h, W/m²K", r,
            {series("all", h, "h_wp_W_m2K", "h_wp_error_W_m2K"), series("solid contacts", h, "h_ss_W_m2K"),
             series("gas lenses", h, "h_sfs_W_m2K"), series("radiation", h, "h_rad_W_m2K")});
  add_chart(page, "Share of each path", "share of h", r,
            {series("solid contacts", h, "share_ss"), series("gas lenses", h, "share_sfs"),
             series("radiation", h, "share_rad")},
            2);
  add_chart(page, "Mean temperature", "T, K", r,
            {series("in the region", h, "mean_temperature_K"), series("leaving", h, "outlet_temperature_K")});
  add_chart(page, "Heat from the walls", "Q, W", r,
            {series("solid contacts", h, "Q_ss_W"), series("gas lenses", h, "Q_sfs_W"),
             series("radiation", h, "Q_rad_W", "Q_rad_error_W")});
  add_chart(page, "Mass flow", "kg/s", r,
            {series("in", h, "mass_flow_in_kg_s"), series("out", h, "mass_flow_out_kg_s")});
  add_chart(page, "Solid fraction in the region", "φ", r, {series("φ", h, "solid_fraction")});
  add_chart(page, "Contacts per particle", "coordination number", r,
            {series("contacts", h, "coordination_number")});
  add_chart(page, "Energy ledger", "relative defect", r, {series("defect", h, "energy_defect")});
}

void add_profile(HtmlReport& page, const std::vector<Bed>& beds, const char* name, int axis) {
  const Box& box = beds.front().box;
  const double diameter = 2 * beds.front().radius_m.front();
  const int slices = std::clamp(static_cast<int>(box.size()[axis] / diameter), 4, 50);
  const Profile p = profile(beds, box, axis, slices);
  const auto chart = [&](const char* what, const std::string& y_label, const std::vector<double>& y) {
    Series points{what, {}, {}, {}, false};
    for (std::size_t k = 0; k < y.size(); ++k)
      if (std::isfinite(y[k])) {
        points.x.push_back(1000 * p.position_m[k]);
        points.y.push_back(y[k]);
      }
    if (std::all_of(points.y.begin(), points.y.end(), [](double v) { return v == 0; }))
      return;  // a frozen bed
    page.chart({fmt::format("{} along {}", what, name),
                fmt::format("{}, mm", name),
                y_label,
                {points},
                false,
                false});
  };
  chart("Solid fraction", "φ", p.solid_fraction);
  chart("Temperature", "T, K", p.temperature_K);
  chart("Downward velocity", "v, m/s", p.velocity_m_s);
}

void add_bed(HtmlReport& page, const CaseFolder& folder) {
  const auto frames = folder.frames();
  if (frames.empty()) return;
  const Bed bed = read_frame(frames.back().file).bed;
  if (bed.size() > 0)
    page.bed(fmt::format("{} particles at {:g} s", bed.size(), bed.time_s), bed_picture(bed));
}

void add_profiles(HtmlReport& page, const CaseFolder& folder) {
  const auto frames = folder.frames();
  const std::size_t count = std::min((frames.size() + 1) / 2, frames_in_profiles);
  std::vector<Bed> beds;
  for (std::size_t k = frames.size() - count; k < frames.size(); ++k) {
    Bed bed = read_frame(frames[k].file).bed;
    if (bed.size() > 0) beds.push_back(std::move(bed));
  }
  if (beds.empty()) return;
  page.heading(fmt::format("Profiles, mean of the last {} frames ({:g} s to {:g} s)", beds.size(),
                           beds.front().time_s, beds.back().time_s));
  add_profile(page, beds, "z", 2);
  add_profile(page, beds, "y", 1);
  add_profile(page, beds, "x", 0);
  page.histogram("Particle temperatures, last frame", "T, K", {{"particles", beds.back().temperature_K}});
}

std::string with_error(const Average& average) {
  return stated(average.mean, average.standard_error).text();
}

void add_walls(HtmlReport& page, const Results& results) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& wall : results.walls)
    rows.push_back({wall.wall, fmt::format("{:.4g}", 1e6 * wall.area_m2), cell(wall.temperature_K, 6),
                    with_error(wall.Q_ss_W), with_error(wall.Q_sfs_W), with_error(wall.Q_rad_W),
                    with_error(wall.Q_W), with_error(wall.flux_W_m2)});
  if (rows.empty()) return;
  page.heading("Heat given by each wall");
  page.table({"wall", "area in the region, mm²", "T, K", "contacts, W", "gas, W", "radiation, W", "all, W",
              "flux, W/m²"},
             rows);
}

void add_head(HtmlReport& page, const Case& c, const Results& r, const RunRecord& record) {
  page.verdict(
      fmt::format(
          "{} Means from {:g} s to {:g} s, {}. Energy stored and received differ by {:.1e} of the heat at most.",
          record.finished ? "Finished." : "Not finished: the state of its last frame and row.", r.from_s,
          r.to_s, r.steady ? "steady" : r.note, r.largest_energy_defect),
      record.finished && r.largest_energy_defect < 1e-6);
  std::vector<Tile> tiles;
  const auto add = [&](const char* column, const std::string& label, const std::string& unit,
                       const PrintUnit& shown = {}) {
    const auto found = r.column.find(column);
    if (found != r.column.end() && std::isfinite(found->second.mean) && found->second.mean != 0)
      tiles.push_back(tile(label, unit.empty() ? shown.name : unit, shown.of(found->second.mean),
                           shown.difference(found->second.standard_error)));
  };
  const PrintUnit K = written_unit(c, "K"), kg_s = written_unit(c, "kg/s");
  add("h_wp_W_m2K", "wall-to-particle coefficient", "W/m²K");
  add("h_rad_W_m2K", "of it by radiation", "W/m²K");
  add("h_sfs_W_m2K", "of it through the gas", "W/m²K");
  add("h_ss_W_m2K", "of it through contacts", "W/m²K");
  add("outlet_temperature_K", "temperature leaving", "", K);
  add("mean_temperature_K", "mean temperature", "", K);
  add("mass_flow_out_kg_s", "mass flow out", "", kg_s);
  add("solid_fraction", "solid fraction", "");
  add("Nu_d", "Nusselt number", "");
  page.tiles(tiles);
}

void add_results(HtmlReport& page, const Results& results) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& column : history_columns()) {
    const auto average = results.column.find(column.name);
    if (std::string(column.name) == "time_s" || average == results.column.end() ||
        !std::isfinite(average->second.mean))
      continue;
    const StatedNumber number = stated(average->second.mean, average->second.standard_error);
    rows.push_back({column.name, number.value, number.error, column.meaning});
  }
  page.heading(fmt::format("Means from {:g} s to {:g} s", results.from_s, results.to_s));
  page.paragraph(results.steady ? "Steady: neither the mean temperature nor the heat drifts over this window."
                                : fmt::format("N{}.", results.note.substr(1)));  // "not steady: ..."
  page.table({"quantity", "mean", "standard error", "meaning"}, rows);
  add_walls(page, results);
}

}  // namespace

int report_case(const std::filesystem::path& where, const RunOptions& options) {
  const CaseFolder folder(where);
  const History history = read_history(folder.history());
  const RunRecord record = read_run_record(folder);
  HtmlReport page(record.scene_name);
  const bool has_rows = !history.at("time_s").empty();
  const Case c = has_rows ? read_case(folder.root() / "scene.toml", {}) : Case{};
  const Results results = has_rows ? summarise(folder, c) : Results{};
  if (has_rows) add_head(page, c, results, record);
  page.paragraph(fmt::format("Radiation: {}.", record.radiation));
  add_bed(page, folder);
  if (has_rows) add_histories(page, history, results);
  add_profiles(page, folder);
  if (has_rows) add_results(page, results);
  page.provenance({{"computed by", fmt::format("granrad {} ({})", record.program_version, record.git_sha)}});
  page.provenance(record.provenance);
  page.write(folder.root() / "report.html");
  if (!options.quiet()) fmt::print("{}\n", (folder.root() / "report.html").string());
  return exit_ok;
}

}  // namespace granrad
