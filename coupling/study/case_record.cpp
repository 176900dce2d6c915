#include "coupling/study/case_record.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "coupling/simulation/case_folder.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"

namespace granrad {

namespace fs = std::filesystem;

std::string this_version() {
  return fmt::format("{} {}", program_version(), program_git_sha());
}

CasePlace place_of(const fs::path& study, const StudyCase& one) {
  const fs::path folder = study / one.name;
  return {folder, folder.string() + ".case.json", folder.string() + ".log"};
}

CaseRecord read_case_record(const fs::path& file) {
  CaseRecord record;
  if (!fs::exists(file)) return record;
  const auto json = nlohmann::json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object() || json.value("format", "") != "granrad.case") return record;
  record.identity = json.value("identity", "");
  record.version = json.value("version", "");
  record.status = json.value("status", "waiting");
  record.message = json.value("message", "");
  record.code = json.value("exit_code", 0);
  record.seconds = json.value("seconds", 0.0);
  return record;
}

void write_case_record(const fs::path& file, const CaseRecord& record) {
  nlohmann::ordered_json json;
  json["format"] = "granrad.case";
  json["format_version"] = 1;
  json["identity"] = record.identity;
  json["version"] = record.version;
  json["status"] = record.status;
  if (!record.message.empty()) json["message"] = record.message;
  json["exit_code"] = record.code;
  json["seconds"] = record.seconds;
  write_text_file(file, json.dump(1) + "\n");
}

}  // namespace granrad
