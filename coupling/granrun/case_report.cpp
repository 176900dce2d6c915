#include "coupling/granrun/case_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "coupling/granrun/profiles.h"
#include "coupling/granrun/results.h"
#include "coupling/granrun/run_record.h"
#include "coupling/simulation/case_folder.h"
#include "dem/base/error.h"
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

void add_chart(HtmlReport& page, const std::string& title, const std::string& y_label,
               std::vector<Series> all) {
  std::erase_if(all, [](const Series& s) {
    return s.y.empty() || std::all_of(s.y.begin(), s.y.end(), [](double y) { return y == 0; });
  });
  if (!all.empty()) page.chart({title, "time, s", y_label, all, false, false});
}

void add_histories(HtmlReport& page, const History& h) {
  page.heading("Histories");
  add_chart(page, "Mean temperature", "T, K",
            {series("in the region", h, "mean_temperature_K"), series("leaving", h, "outlet_temperature_K")});
  add_chart(page, "Heat from the walls", "Q, W",
            {series("solid contacts", h, "Q_ss_W"), series("gas lenses", h, "Q_sfs_W"),
             series("radiation", h, "Q_rad_W")});
  add_chart(page, "Wall-to-particle coefficients", "h, W/m²K",
            {series("all", h, "h_wp_W_m2K"), series("solid contacts", h, "h_ss_W_m2K"),
             series("gas lenses", h, "h_sfs_W_m2K"), series("radiation", h, "h_rad_W_m2K")});
  add_chart(page, "Mass flow", "kg/s",
            {series("in", h, "mass_flow_in_kg_s"), series("out", h, "mass_flow_out_kg_s")});
  add_chart(page, "Solid fraction in the region", "φ", {series("φ", h, "solid_fraction")});
  add_chart(page, "Contacts per particle", "coordination number",
            {series("contacts", h, "coordination_number")});
  add_chart(page, "Energy ledger", "|stored − received| / received", {series("defect", h, "energy_defect")});
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

void add_results(HtmlReport& page, const Results& results) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& column : history_columns()) {
    const Average& average = results.column.at(column.name);
    if (std::string(column.name) == "time_s" || !std::isfinite(average.mean)) continue;
    rows.push_back(
        {column.name, fmt::format("{:.6g}", average.mean),
         std::isfinite(average.standard_error) ? fmt::format("{:.2g}", average.standard_error) : ""});
  }
  page.heading(fmt::format("Means from {:g} s to {:g} s", results.from_s, results.to_s));
  page.table({"quantity", "mean", "standard error"}, rows);
}

}  // namespace

int report_case(const std::filesystem::path& where, const RunOptions& options) {
  const CaseFolder folder(where);
  const History history = read_history(folder.history());
  const RunRecord record = read_run_record(folder);
  HtmlReport page(record.scene_name);
  page.paragraph(fmt::format(
      "granrad {} ({}). Radiation: {}. {}", record.program_version, record.git_sha, record.radiation,
      record.finished ? "Finished." : "Not finished: the state of its last frame and row."));
  if (!history.at("time_s").empty()) {
    add_results(page, summarise(history));
    add_histories(page, history);
  }
  add_profiles(page, folder);
  page.write(folder.root() / "report.html");
  if (!options.quiet()) fmt::print("{}\n", (folder.root() / "report.html").string());
  return exit_ok;
}

}  // namespace granrad
