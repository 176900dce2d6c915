#include "coupling/granrun/run_record.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/simulation/radiation_source.h"
#include "dem/base/program.h"
#include "dem/base/text_file.h"

namespace granrad {

namespace {

nlohmann::ordered_json as_json(const Results& results) {
  nlohmann::ordered_json json;
  json["from_s"] = results.from_s;
  json["to_s"] = results.to_s;
  json["largest_energy_defect"] = results.largest_energy_defect;
  if (std::isfinite(results.final_mean_temperature_K))
    json["final_mean_temperature_K"] = results.final_mean_temperature_K;
  for (const auto& column : history_columns()) {
    const auto& average = results.column.at(column.name);
    if (std::isfinite(average.mean)) json["means"][column.name] = average.mean;
    if (std::isfinite(average.standard_error)) json["standard_errors"][column.name] = average.standard_error;
  }
  return json;
}

nlohmann::ordered_json as_json(const PartSeconds& seconds) {
  return {{"flow", seconds.flow}, {"conduction", seconds.conduction}, {"radiation", seconds.radiation}};
}

}  // namespace

void write_run_record(const CaseFolder& folder, const Case& c, const Simulation& simulation,
                      const Results* results) {
  nlohmann::ordered_json json;
  json["format"] = "granrad.run";
  json["format_version"] = 1;
  json["program"] = {{"version", program_version()}, {"git_sha", program_git_sha()}};
  json["scene"] = {{"name", c.flow.name}, {"hash_fnv1a64", text_hash(c.effective_text)}};
  json["seeds"] = {{"feed", c.flow.feed.seed}, {"radiation", c.heat.radiation.seed}};
  json["radiation"] = describe(c.heat.radiation);
  const TimePlan& plan = simulation.plan();
  json["steps"] = {
      {"step_s", plan.step_s}, {"heat_step_s", plan.tick_s}, {"end_time_s", plan.time_s(plan.end_tick)}};
  json["finished"] = results != nullptr;
  if (results) {
    json["results"] = as_json(*results);
    json["computing_seconds"] = as_json(simulation.seconds());
  }
  write_text_file(folder.run_json(), json.dump(1) + "\n");
}

bool is_finished(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "run.json")) return false;
  const auto json = nlohmann::json::parse(read_text_file(folder / "run.json"), nullptr, false);
  return json.is_object() && json.value("finished", false);
}

std::string text_hash(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ull;
  for (unsigned char c : text) hash = (hash ^ c) * 1099511628211ull;
  return fmt::format("{:016x}", hash);
}

}  // namespace granrad
