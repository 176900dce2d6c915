#pragma once
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace granrad {

/// Notes what a test found for the validation book: into the JSON file that GRANRAD_RECORD names, as NAME and
/// NAME_error. Without it nothing happens.
inline void record(const std::string& name, double value, double error = 0) {
  const char* file = std::getenv("GRANRAD_RECORD");
  if (!file) return;
  nlohmann::ordered_json json;
  if (std::ifstream in(file); in) json = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!json.is_object()) json = nlohmann::ordered_json::object();
  json[name] = value;
  json[name + "_error"] = error;
  std::ofstream(file) << json.dump(1) << "\n";
}

}  // namespace granrad
