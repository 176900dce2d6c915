#include "coupling/study/study_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "coupling/results/results.h"
#include "coupling/simulation/case_folder.h"
#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/files/text_file.h"
#include "dem/io/snapshot.h"
#include "fit/correlation/correlation.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Quantities of_run(const fs::path& folder) {
  Quantities all;
  const Results results =
      summarise(CaseFolder(folder), read_case(folder / "scene.toml", {}));  // its own window
  for (const auto& [name, average] : results.column) all[name] = {average.mean, average.standard_error};
  all["energy_defect_max"] = {results.largest_energy_defect, 0};
  all["final_mean_temperature_K"] = {results.final_mean_temperature_K, 0};
  const auto derive = [&](const std::string& name, const std::string& formula) {
    if (!all.count(name)) all[name] = evaluate(formula, all);
  };
  // Of the history's own columns: their errors know that parts and whole move together.
  derive("Nu_ss", "Nu_d_ss");
  derive("Nu_sfs", "Nu_d_sfs");
  derive("Nu_rad", "Nu_d_rad");
  derive("Nu_cond", "Nu_d_ss + Nu_d_sfs");
  derive("share_ss_pct", "100 * share_ss");
  derive("share_sfs_pct", "100 * share_sfs");
  derive("share_rad_pct", "100 * share_rad");
  return all;
}

/// Mean of one frame with the standard error of its particles; a count has none.
Measured probe_frame(const StudyProbe& probe, const Bed& bed) {
  const double unit = probe.in_diameters ? mean_diameter_m(bed.radius_m) : 1;
  const double low = bed.box.min[probe.axis];
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const double at = bed.position_m[i][probe.axis] - low;
    if (!bed.box.contains(bed.position_m[i]) || at < probe.from * unit || at >= probe.to * unit) continue;
    const double value = probe.what == "count"          ? 1
                         : probe.what == "velocity_m_s" ? -bed.velocity_m_s[i].z
                                                        : bed.temperature_K[i];
    n += 1, sum += value, squares += value * value;
  }
  if (probe.what == "count") return {n, 0};
  if (n < 2) return {unknown, unknown};
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1))};
}

Measured probe_run(const StudyProbe& probe, const fs::path& folder) {
  const auto frames = CaseFolder(folder).frames();
  if (frames.empty()) return {unknown, unknown};
  if (probe.last) return probe_frame(probe, read_frame(frames.back().file).bed);
  double n = 0, sum = 0, squares = 0;
  for (std::size_t k = frames.size() / 2; k < frames.size(); ++k) {
    const double value = probe_frame(probe, read_frame(frames[k].file).bed).value;
    n += 1, sum += value, squares += value * value;
  }
  return {sum / n, n > 1 ? std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1)) : unknown};
}

/// One quantity for each number of validation.csv, by source and time.
Quantities of_validation(const fs::path& folder) {
  Quantities all;
  const CsvTable table = read_csv(folder / "validation.csv");
  const std::size_t source = table.column("source"), time = table.column("time_s");
  for (const auto& cells : table.rows)
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (const double value = cell_number(cells[k]); std::isfinite(value))
        all[fmt::format("{}@{}:{}", cells[source], cells[time], table.names[k])] = {value, 0};
  return all;
}

void flatten(const nlohmann::json& json, const std::string& name, Quantities& all) {
  if (json.is_number()) all[name] = {json.get<double>(), 0};
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      flatten(value, name.empty() ? key : fmt::format("{}.{}", name, key), all);
}

Quantities of_json(const fs::path& file) {
  const auto json = nlohmann::json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object()) throw IoError(fmt::format("{}: is no JSON object", file.string()));
  Quantities all;
  flatten(json, "", all);
  for (auto& [name, measured] : all)
    if (const auto error = all.find(name + "_error"); error != all.end())
      measured.error = error->second.value;
  return all;
}

/// Of each wall, the sum of its view factors to particles: y_min:to_particles, over the snapshots traced.
Quantities of_traces(const fs::path& folder) {
  std::map<std::string, std::vector<double>> sums;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".h5") continue;
    const ViewFactorFile traced = read_view_factors(entry.path());
    const auto factor = closed_factors(traced.closed).value;
    const auto& pattern = traced.closed.pattern;
    const std::size_t spheres = traced.enclosure.sphere_count();
    for (std::size_t w = 0; w < traced.enclosure.walls.size(); ++w) {
      double sum = 0;
      for (auto k = pattern.row_begin[spheres + w]; k < pattern.row_begin[spheres + w + 1]; ++k)
        if (static_cast<std::size_t>(pattern.column[k]) < spheres) sum += factor[k];
      sums[traced.enclosure.walls[w].name + ":to_particles"].push_back(sum);
    }
  }
  Quantities all;
  for (auto& [name, values] : sums) {
    std::sort(values.begin(), values.end());  // whatever the order of the files
    double sum = 0, squares = 0;
    for (const double value : values) sum += value, squares += value * value;
    const auto n = static_cast<double>(values.size());
    const double variance = std::max(0.0, squares / n - sum * sum / (n * n));
    all[name] = {sum / n, n > 1 ? std::sqrt(variance / (n - 1)) : unknown};
  }
  return all;
}

/// RMSEs of a fitted table, the largest and by row: pp_rmse, pw_rmse, 0.43:pp_rmse.
Quantities of_table(const fs::path& file) {
  Quantities all;
  for (const auto& row : read_correlation(file).rows)
    for (const auto& [name, rmse] :
         {std::pair{"pp_rmse", row.statistics.pp_rmse}, std::pair{"pw_rmse", row.statistics.pw_rmse}}) {
      all[fmt::format("{:.2f}:{}", row.solid_fraction, name)] = {rmse, 0};
      all[name].value = std::max(all[name].value, rmse);
    }
  return all;
}

Quantities of_case(const StudyCase& one, const fs::path& folder) {
  switch (one.kind) {
    case StudyKind::run:
      return of_run(folder);
    case StudyKind::validate:
      return of_validation(folder);
    case StudyKind::measure:
      return of_json(folder / "measure.json");
    case StudyKind::command:
      return fs::exists(folder / "results.json") ? of_json(folder / "results.json") : Quantities{};
    case StudyKind::fit:
      return of_table(folder / "table.toml");
    case StudyKind::trace:
      return of_traces(folder);
  }
  return {};
}

Quantities averaged(const std::vector<Quantities>& replicates) {
  if (replicates.size() == 1) return replicates.front();
  Quantities all;
  const auto n = static_cast<double>(replicates.size());
  for (const auto& [name, first] : replicates.front()) {
    double sum = 0, squares = 0;
    for (const auto& one : replicates) sum += one.count(name) ? one.at(name).value : unknown;
    for (const auto& one : replicates)
      squares += one.count(name) ? std::pow(one.at(name).value - sum / n, 2) : unknown;
    all[name] = {sum / n, std::sqrt(squares / (n * (n - 1)))};
  }
  return all;
}

void add_varied(StudyRow& row) {
  for (const auto& [key, value] : row.of->varied) {
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (end != value.c_str() && *end == '\0') row.quantity[key] = {number, 0};
  }
}

/// Cases of another kind may lack what the formula needs; a formula that suits no case of a whole study is wrong.
void add_column(const StudyColumn& column, std::vector<StudyRow>& rows) {
  std::string problem;
  bool any = false, whole = true;
  for (auto& row : rows) {
    if (row.finished == 0) whole = false;
    if (row.finished == 0) continue;
    try {
      row.quantity[column.name] = evaluate(column.formula, row.quantity);
      any = true;
    } catch (const InputError& error) {
      problem = error.what();
    }
  }
  if (!any && whole && !problem.empty())
    throw InputError(fmt::format("[[column]] {}: {}", column.name, problem));
}

}  // namespace

std::string StudyRow::status() const {
  std::string worst = records.empty() ? "skipped" : "finished";
  for (const auto& record : records)
    if (record.status != "finished" && worst != "failed") worst = record.status;
  return worst;
}

std::vector<StudyRow> collect(const Study& study, const fs::path& folder) {
  std::vector<StudyRow> rows;
  for (const auto& one : study.cases) {
    if (!rows.empty() && rows.back().of->point == one.point) continue;
    StudyRow row{&one, {}, 0, 0, {}};
    std::vector<Quantities> replicates;
    for (const auto* replicate : study.of_point(one.point)) {
      if (replicate->skipped) continue;
      row.records.push_back(read_case_record(place_of(folder, *replicate).record));
      row.seconds += row.records.back().seconds;
      if (row.records.back().status != "finished") continue;
      replicates.push_back(of_case(*replicate, folder / replicate->name));
      for (const auto& probe : study.probes)
        if (replicate->kind == StudyKind::run && (probe.group.empty() || probe.group == replicate->group))
          replicates.back()[probe.name] = probe_run(probe, folder / replicate->name);
    }
    row.finished = static_cast<int>(replicates.size());
    if (row.finished > 0) row.quantity = averaged(replicates);
    add_varied(row);
    rows.push_back(std::move(row));
  }
  for (const auto& column : study.columns) add_column(column, rows);
  return rows;
}

}  // namespace granrad
