#include "coupling/granrun/run_record.h"

#include <fmt/core.h>
#include <omp.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/simulation/case_lock.h"

#include "coupling/simulation/radiation_source.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

nlohmann::ordered_json as_json(const Results& results) {
  nlohmann::ordered_json json;
  json["from_s"] = results.from_s;
  json["to_s"] = results.to_s;
  json["steady"] = results.steady;
  json["largest_energy_defect"] = results.largest_energy_defect;
  if (std::isfinite(results.final_mean_temperature_K))
    json["final_mean_temperature_K"] = results.final_mean_temperature_K;
  for (const auto& column : history_columns()) {
    const auto found = results.column.find(column.name);
    if (found == results.column.end()) continue;
    const Average& average = found->second;
    if (std::isfinite(average.mean)) json["means"][column.name] = average.mean;
    if (std::isfinite(average.standard_error)) json["standard_errors"][column.name] = average.standard_error;
  }
  return json;
}

/// An empty object when there is none, or a damaged one.
nlohmann::json parsed(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return nlohmann::json::object();
  auto json = nlohmann::json::parse(read_text_file(file), nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

/// Who computes this, where and how long, added to what runs before this one took.
nlohmann::ordered_json process(const RunOptions& options, const nlohmann::json& before) {
  static const std::string started = date_of_now();
  const auto earlier = before.value("process", nlohmann::json::object());
  const bool same = earlier.is_object() && earlier.contains("pid") && earlier["pid"] == getpid();
  const auto seconds = [&](const char* key) {
    return earlier.is_object() && earlier.contains(key) && earlier[key].is_number()
               ? earlier[key].get<double>()
               : 0.0;
  };
  const double before_s = same ? seconds("wall_seconds_before") : seconds("wall_seconds");
  nlohmann::ordered_json json;
  json["host"] = host_name();
  json["pid"] = getpid();
  json["threads"] = options.threads > 0 ? options.threads : omp_get_max_threads();
  if (rank_count() > 1) json["ranks"] = rank_count();
  json["command_line"] = options.command_line;
  json["first_started"] = earlier.is_object() ? earlier.value("first_started", started) : started;
  json["started"] = started;
  json["written"] = date_of_now();
  json["wall_seconds_before"] = before_s;
  json["wall_seconds"] = before_s + wall_seconds();
  return json;
}

nlohmann::ordered_json as_json(const PartSeconds& seconds) {
  return {{"flow", seconds.flow},
          {"conduction", seconds.conduction},
          {"radiation", seconds.radiation},
          {"output", seconds.output},
          {"between_ranks", seconds_between_ranks()}};
}

}  // namespace

void write_run_record(const CaseFolder& folder, const Case& c, const Simulation& simulation,
                      const RunOptions& options, const Results* results) {
  const nlohmann::json before = parsed(folder.run_json());
  nlohmann::ordered_json json;
  json["format"] = "granrad.run";
  json["format_version"] = 2;
  json["program"] = {{"version", program_version()},
                     {"git_sha", program_git_sha()},
                     {"compiler", GRANRAD_COMPILER},
                     {"libraries", GRANRAD_LIBRARIES}};
  json["scene"] = {{"name", c.flow.name}, {"hash_fnv1a64", fmt::format("{:016x}", text_hash(c.identity))}};
  json["inputs"] = nlohmann::ordered_json::object();
  for (const auto& input : c.inputs)
    json["inputs"][input.stored_as] = {{"from", input.file.string()},
                                       {"hash_fnv1a64", fmt::format("{:016x}", input.hash)}};
  json["process"] = process(options, before);
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

namespace {

std::vector<std::pair<std::string, std::string>> provenance_of(const nlohmann::json& json) {
  std::vector<std::pair<std::string, std::string>> lines;
  const auto say = [&](const char* what, const char* table, const char* key, const char* unit = "") {
    const auto part = json.find(table);
    if (part == json.end() || !part->is_object() || !part->contains(key)) return;
    const auto& value = part->at(key);
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    lines.emplace_back(what, fmt::format("{}{}", text, unit));
  };
  say("command", "process", "command_line");
  say("host", "process", "host");
  say("threads", "process", "threads");
  say("started", "process", "first_started");
  say("written", "process", "written");
  say("wall time", "process", "wall_seconds", " s");
  say("compiler", "program", "compiler");
  say("libraries", "program", "libraries");
  say("seed of the feed", "seeds", "feed");
  say("seed of the radiation", "seeds", "radiation");
  say("hash of the scene", "scene", "hash_fnv1a64");
  return lines;
}

}  // namespace

RunRecord read_run_record(const CaseFolder& folder) {
  const auto json = parsed(folder.run_json());
  try {
    RunRecord record;
    record.scene_name = json.at("scene").at("name");
    record.program_version = json.at("program").at("version");
    record.git_sha = json.at("program").at("git_sha");
    record.radiation = json.at("radiation");
    record.finished = json.at("finished");
    record.end_time_s = json.at("steps").at("end_time_s");
    record.provenance = provenance_of(json);
    return record;
  } catch (const nlohmann::json::exception&) {
    throw IoError(advised(fmt::format("{}: damaged (not a record of a run)", folder.run_json().string()),
                          "granrun run SCENE -o DIR --resume writes it anew"));
  }
}

bool is_finished(const std::filesystem::path& folder) {
  const auto json = parsed(folder / "run.json");
  const auto finished = json.find("finished");
  return finished != json.end() && finished->is_boolean() && finished->get<bool>();
}

}  // namespace granrad
