#include "coupling/study/study_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coupling/simulation/history.h"
#include "dem/base/files/csv.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

/// Keys in the order in which they first appear.
std::vector<std::string> varied_keys(const std::vector<StudyRow>& rows) {
  std::vector<std::string> keys;
  for (const auto& row : rows)
    for (const auto& [key, value] : row.of->varied)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  return keys;
}

/// Columns of the history in its order, then the others by name.
std::vector<std::string> quantities(const std::vector<StudyRow>& rows,
                                    const std::vector<std::string>& varied) {
  std::set<std::string> names;
  for (const auto& row : rows)
    for (const auto& [name, measured] : row.quantity)
      if (name.find(':') == std::string::npos &&
          std::find(varied.begin(), varied.end(), name) == varied.end())
        names.insert(name);
  std::vector<std::string> ordered;
  for (const auto& column : history_columns())
    if (names.erase(column.name)) ordered.push_back(column.name);
  ordered.insert(ordered.end(), names.begin(), names.end());
  return ordered;
}

bool has_error(const std::vector<StudyRow>& rows, const std::string& name) {
  return std::any_of(rows.begin(), rows.end(), [&](const StudyRow& row) {
    const auto found = row.quantity.find(name);
    return found != row.quantity.end() && std::isfinite(found->second.error) && found->second.error > 0;
  });
}

std::string varied_value(const StudyRow& row, const std::string& key) {
  for (auto one = row.of->varied.rbegin(); one != row.of->varied.rend(); ++one)
    if (one->first == key) return one->second;
  return "";
}

std::string command(const Study& study, const fs::path& folder, const std::string& name) {
  return fmt::format("granrun study {} -o {} --case {}", shell_word(study.file.string()),
                     shell_word(fs::absolute(folder).string()), shell_word(name));
}

std::string python_text(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return fmt::format("\"{}\"", inside);
}

std::string snakefile(const Study& study, const fs::path& folder) {
  std::string needs;
  for (const auto& one : study.cases) {
    std::vector<std::string> points = one.from;
    if (!one.start.empty()) points.push_back(one.start);
    std::string list;
    for (const auto& point : points)
      for (const auto* other : study.of_point(point)) list += python_text(other->name) + ", ";
    needs += fmt::format("    {}: [{}],\n", python_text(one.name), list);
  }
  const auto file = python_text(study.file.string()), where = python_text(fs::absolute(folder).string());
  return fmt::format(
      "# snakemake --cores N runs every case of the study, then its tables.\n"
      "STUDY = {}\nFOLDER = {}\nNEEDS = {{\n{}}}\n\n"
      "rule all:\n    input: FOLDER + \"/.done/tables\"\n\n"
      "rule tables:\n    input: expand(FOLDER + \"/.done/{{case}}.case\", case=NEEDS)\n"
      "    output: touch(FOLDER + \"/.done/tables\")\n"
      "    shell: \"granrun study {{STUDY:q}} -o {{FOLDER:q}} -q\"\n\n"
      "rule case:\n"
      "    input: lambda w: expand(FOLDER + \"/.done/{{case}}.case\", case=NEEDS[w.case])\n"
      "    output: touch(FOLDER + \"/.done/{{case}}.case\")\n"
      "    threads: 1\n"
      "    shell: \"granrun study {{STUDY:q}} -o {{FOLDER:q}} --case {{wildcards.case:q}} -q\"\n",
      file, where, needs);
}

}  // namespace

std::string shell_word(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return fmt::format("'{}'", inside);
}

std::string study_csv(const std::vector<StudyRow>& rows) {
  const auto keys = varied_keys(rows);
  const auto names = quantities(rows, keys);
  std::string text = "case,group,kind,status,replicates,seconds";
  for (const auto& key : keys) text += fmt::format(",{}", text_cell(key));
  for (const auto& name : names) {
    text += fmt::format(",{}", name);
    if (has_error(rows, name)) text += fmt::format(",{}_stderr", name);
  }
  text += "\n";
  for (const auto& row : rows) {
    text += fmt::format("{},{},{},{},{},{:.4g}", row.of->point, row.of->group, to_string(row.of->kind),
                        row.status(), row.finished, row.seconds);
    for (const auto& key : keys) text += fmt::format(",{}", text_cell(varied_value(row, key)));
    for (const auto& name : names) {
      const auto found = row.quantity.find(name);
      const bool there = found != row.quantity.end();
      text += fmt::format(",{}", there ? cell(found->second.value, 9) : "");
      if (has_error(rows, name)) text += fmt::format(",{}", there ? cell(found->second.error, 3) : "");
    }
    text += "\n";
  }
  return text;
}

void write_job_files(const Study& study, const fs::path& folder) {
  std::string jobs;
  for (const auto& one : study.cases) jobs += command(study, folder, one.name) + "\n";
  write_text_file(folder / "jobs.txt", jobs);
  write_text_file(
      folder / "slurm_array.sh",
      fmt::format("#!/bin/bash\n# sbatch slurm_array.sh: one case a task. Cases that take files from "
                  "others wait for them only in the\n# Snakefile; here submit the array again until "
                  "nothing is left.\n#SBATCH --array=1-{}\n#SBATCH --cpus-per-task=1\n"
                  "eval \"$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {})\"\n",
                  study.cases.size(), shell_word(fs::absolute(folder / "jobs.txt").string())));
  write_text_file(folder / "Snakefile", snakefile(study, folder));
}

}  // namespace granrad
