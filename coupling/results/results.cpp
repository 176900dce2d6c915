#include "coupling/results/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/results/written_units.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/stated_number.h"

namespace granrad {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// The values of a column where every row has one; nothing otherwise.
std::optional<Watched> watched(const History& history, const std::string& column, const std::string& name,
                               const std::string& unit) {
  const auto found = history.find(column);
  if (found == history.end() ||
      !std::all_of(found->second.begin(), found->second.end(), [](double v) { return std::isfinite(v); }))
    return {};
  return Watched{name, unit, found->second};
}

/// The heat all walls gave in each row.
Watched heat_from_walls(const History& history) {
  Watched heat{"the heat from the walls", "W", std::vector<double>(history.at("time_s").size(), 0.0)};
  for (const char* path : {"Q_ss_W", "Q_sfs_W", "Q_rad_W"})
    for (std::size_t k = 0; k < heat.values.size(); ++k) heat.values[k] += history.at(path)[k];
  return heat;
}

/// What must stand still for a flow to be steady.
std::vector<Watched> watched_quantities(const History& history) {
  std::vector<Watched> all;
  if (auto T = watched(history, "mean_temperature_K", "T", "K")) all.push_back(*T);
  if (auto h = watched(history, "h_wp_W_m2K", "h", "W/m2K"))
    all.push_back(*h);
  else
    all.push_back(heat_from_walls(history));
  return all;
}

/// "T rises 22 K/s; about 3 s needed".
std::string note_of(const History& history, const StationaryWindow& window, const std::vector<Watched>& all) {
  double needed_s = undefined;
  const auto& time = history.at("time_s");
  for (const auto& one : all) needed_s = std::fmax(needed_s, relaxed_at_s(time, one.values));
  const auto& stays = history.at("residence_time_s");
  if (!stays.empty() && std::isfinite(stays.back())) needed_s = std::fmax(needed_s, 2 * stays.back());
  if (!(needed_s > time.back())) return "not steady: " + window.why;
  return fmt::format("not steady: {}; about {:.2g} s needed", window.why, needed_s);
}

/// The rows from `first` on.
std::vector<double> rows_from(const std::vector<double>& values, std::size_t first) {
  return {values.begin() + static_cast<std::ptrdiff_t>(std::min(first, values.size())), values.end()};
}

std::vector<WallResult> wall_results(const std::vector<WallRow>& rows, double from_s) {
  std::vector<WallResult> results;
  std::map<std::string, std::array<std::vector<double>, 4>> heats;
  for (const WallRow& row : rows) {
    if (row.time_s <= from_s * (1 + 1e-9) && from_s > 0) continue;
    auto& of = heats[row.wall];
    if (of[0].empty()) results.push_back({row.wall, row.area_m2, row.temperature_K, {}, {}, {}, {}, {}});
    for (WallResult& wall : results)
      if (wall.wall == row.wall && wall.temperature_K != row.temperature_K) wall.temperature_K = undefined;
    of[0].push_back(row.Q_ss_W);
    of[1].push_back(row.Q_sfs_W);
    of[2].push_back(row.Q_rad_W);
    of[3].push_back(row.Q_ss_W + row.Q_sfs_W + row.Q_rad_W);
  }
  for (WallResult& wall : results) {
    const auto& of = heats.at(wall.wall);
    wall.Q_ss_W = average_of(of[0]);
    wall.Q_sfs_W = average_of(of[1]);
    wall.Q_rad_W = average_of(of[2]);
    wall.Q_W = average_of(of[3]);
    const double per_area = wall.area_m2 > 0 ? 1 / wall.area_m2 : undefined;
    wall.flux_W_m2 = {wall.Q_W.mean * per_area, wall.Q_W.standard_error * per_area};
  }
  return results;
}

void line(const std::string& what, const Average& average, const PrintUnit& unit) {
  if (!std::isfinite(average.mean) || average.mean == 0) return;
  const double mean = unit.of(average.mean), error = unit.difference(average.standard_error);
  if (average.standard_error > 1e-12 * std::abs(average.mean)) {  // below: rounding of a constant
    const StatedNumber number = stated(mean, error);
    fmt::print("  {:<34}{:>12} +- {:<9} {}\n", what, number.value, number.error, unit.name);
  } else {
    fmt::print("  {:<34}{:>12.5g}              {}\n", what, mean, unit.name);
  }
}

void line(const std::string& what, const Average& average, const char* unit) {
  line(what, average, PrintUnit{unit});
}

void print_walls(const Results& results, const PrintUnit& K) {
  for (const WallResult& wall : results.walls) {
    if (!(std::abs(wall.Q_W.mean) > 0)) continue;
    const bool one_temperature = std::isfinite(wall.temperature_K);
    line(one_temperature
             ? fmt::format("heat from {} ({:.6g} {})", wall.wall, K.of(wall.temperature_K), K.name)
             : "heat from " + wall.wall,
         wall.Q_W, "W");
    line("  per area in the region", wall.flux_W_m2, "W/m2");
  }
}

void print_seconds(const PartSeconds& s) {
  const double total = s.flow + s.conduction + s.radiation + s.output;
  if (total <= 0) return;
  const auto part = [&](double seconds) { return 100 * seconds / total; };
  fmt::print(
      "  computing: flow {:.1f} s ({:.0f} %), conduction {:.1f} s ({:.0f} %),\n"
      "    radiation {:.1f} s ({:.0f} %), output {:.1f} s ({:.0f} %)\n",
      s.flow, part(s.flow), s.conduction, part(s.conduction), s.radiation, part(s.radiation), s.output,
      part(s.output));
}

}  // namespace

double Results::mean(const std::string& name) const {
  const auto found = column.find(name);
  return found == column.end() ? undefined : found->second.mean;
}

Results summarise(const History& history, const std::vector<WallRow>& walls,
                  std::optional<double> average_from_s) {
  Results results;
  const auto& time = history.at("time_s");
  if (time.empty()) {
    for (const auto& column : history_columns()) results.column[column.name] = average_of({});
    results.final_mean_temperature_K = undefined;
    results.note = "not steady: there are no rows yet";
    return results;
  }
  const auto all = watched_quantities(history);
  const StationaryWindow window = stationary_window(time, all);
  results.steady = window.steady;
  if (!window.steady) results.note = note_of(history, window, all);
  std::size_t first = window.first_row;
  if (average_from_s)
    first = std::upper_bound(time.begin(), time.end(), *average_from_s * (1 + 1e-9)) - time.begin();
  first = std::min(first, time.size() - 1);
  results.from_s = first > 0 ? time[first - 1] : 0;
  results.to_s = time.back();
  for (const auto& [name, values] : history) results.column[name] = average_of(rows_from(values, first));
  results.walls = wall_results(walls, results.from_s);
  for (double defect : history.at("energy_defect"))
    results.largest_energy_defect = std::max(results.largest_energy_defect, defect);
  results.final_mean_temperature_K = history.at("mean_temperature_K").back();
  return results;
}

Results summarise(const CaseFolder& folder, const Case& c) {
  return summarise(read_history(folder.history()), read_wall_history(folder.wall_history()),
                   c.heat.output.average_from_s);
}

void print_results(const Case& c, const Results& results, const Simulation& simulation,
                   const CaseFolder& folder) {
  const auto& of = results.column;
  fmt::print("{}: means from {:g} s to {:g} s{}\n  radiation: {}\n", c.flow.name, results.from_s,
             results.to_s, results.steady ? ", steady" : "", describe(c.heat.radiation));
  if (!results.note.empty()) fmt::print("  {}\n", results.note);
  line("wall to particles, h_wp", of.at("h_wp_W_m2K"), "W/m2K");
  line("  solid contacts", of.at("h_ss_W_m2K"), "W/m2K");
  line("  gas lenses", of.at("h_sfs_W_m2K"), "W/m2K");
  line("  radiation", of.at("h_rad_W_m2K"), "W/m2K");
  line("Nusselt number Nu_d", of.at("Nu_d"), "");
  const PrintUnit K = written_unit(c, "K"), kg_s = written_unit(c, "kg/s");
  print_walls(results, K);
  line("mean temperature in the region", of.at("mean_temperature_K"), K);
  line("temperature of leaving particles", of.at("outlet_temperature_K"), K);
  line("solid fraction in the region", of.at("solid_fraction"), "");
  if (simulation.fed().inserted + simulation.fed().removed > 0) {
    line("mass flow in", of.at("mass_flow_in_kg_s"), kg_s);
    line("mass flow out", of.at("mass_flow_out_kg_s"), kg_s);
    line("mean velocity", of.at("mean_velocity_m_s"), written_unit(c, "m/s"));
    line("residence time", of.at("residence_time_s"), written_unit(c, "s"));
    line("Peclet number Pe_L", of.at("Pe_L"), "");
  }
  line("contacts per particle", of.at("coordination_number"), "");
  const double final_K = results.final_mean_temperature_K;
  fmt::print("  at the end: {} particles, {} in the region\n", simulation.bed().size(),
             std::isfinite(final_K) ? fmt::format("{:.2f} {}", K.of(final_K), K.name) : "none");
  fmt::print("  energy: |stored - received| / received = {:.1e} at most\n", results.largest_energy_defect);
  print_seconds(simulation.seconds());
  fmt::print("  history  {}\n  walls    {}\n  frames   {}\n", folder.history().string(),
             folder.wall_history().string(), (folder.root() / "run.hdf.series").string());
}

}  // namespace granrad
