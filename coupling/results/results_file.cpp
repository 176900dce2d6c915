#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/results/results.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace {

nlohmann::ordered_json as_json(const Average& average) {
  nlohmann::ordered_json json;
  json["mean"] = std::isfinite(average.mean) ? nlohmann::ordered_json(average.mean) : nullptr;
  json["standard_error"] =
      std::isfinite(average.standard_error) ? nlohmann::ordered_json(average.standard_error) : nullptr;
  return json;
}

nlohmann::ordered_json as_json(const WallResult& wall) {
  return {{"area_m2", wall.area_m2},
          {"temperature_K", wall.temperature_K},
          {"Q_ss_W", as_json(wall.Q_ss_W)},
          {"Q_sfs_W", as_json(wall.Q_sfs_W)},
          {"Q_rad_W", as_json(wall.Q_rad_W)},
          {"Q_W", as_json(wall.Q_W)},
          {"flux_W_m2", as_json(wall.flux_W_m2)}};
}

}  // namespace

void write_results(const CaseFolder& folder, const Case& c, const Results& results) {
  nlohmann::ordered_json json;
  json["format"] = "granrad.results";
  json["format_version"] = 1;
  json["scene"] = c.flow.name;
  json["radiation"] = describe(c.heat.radiation);
  json["window"] = {{"from_s", results.from_s}, {"to_s", results.to_s}};
  json["steady"] = results.steady;
  json["note"] = results.note;
  for (const auto& column : history_columns()) {
    const auto found = results.column.find(column.name);
    if (std::string(column.name) == "time_s" || found == results.column.end() ||
        !std::isfinite(found->second.mean))
      continue;
    json["means"][column.name] = as_json(found->second);
  }
  json["walls"] = nlohmann::ordered_json::object();
  for (const auto& wall : results.walls) json["walls"][wall.wall] = as_json(wall);
  json["largest_energy_defect"] = results.largest_energy_defect;
  write_text_file(folder.results(), json.dump(1) + "\n");
}

}  // namespace granrad
