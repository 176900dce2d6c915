#include "coupling/granrun/sweep.h"

#include <fmt/core.h>

#include <cctype>
#include <chrono>
#include <set>

#include "coupling/granrun/results.h"
#include "coupling/granrun/run.h"
#include "coupling/granrun/run_record.h"
#include "dem/base/error.h"
#include "dem/base/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

struct Variation {
  std::string key;
  std::vector<std::string> values;  ///< as TOML
};

std::string folder_name(const std::string& text) {
  std::string name;
  for (char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_' ? c : '_';
  return name;
}

/// "feed.solid_fraction=0.07" -> "solid_fraction-0.07"
std::string short_name(const std::string& key, const std::string& value) {
  const auto dot = key.rfind('.');
  return folder_name((dot == std::string::npos ? key : key.substr(dot + 1)) + "-" + value);
}

std::vector<Variation> read_variations(TomlTable root) {
  std::vector<Variation> all;
  for (auto& table : root.tables("vary")) {
    Variation variation{table.string("key"), {}};
    if (table.has("values"))
      for (double value : table.number_list("values", {}, 1))
        variation.values.push_back(fmt::format("{}", value));
    if (table.has("texts"))
      for (const auto& text : table.string_list("texts", 1)) variation.values.push_back(text);
    if (variation.values.empty())
      table.problem("values", "is missing: a list of numbers in values, or of texts in texts");
    all.push_back(variation);
  }
  return all;
}

std::vector<SweepCase> combinations(const std::vector<Variation>& variations) {
  std::vector<SweepCase> cases(variations.empty() ? 0 : 1);
  for (const auto& variation : variations) {
    std::vector<SweepCase> longer;
    for (const auto& shorter : cases)
      for (const auto& value : variation.values) {
        SweepCase next = shorter;
        next.name += fmt::format("{}{}", next.name.empty() ? "" : "_", short_name(variation.key, value));
        next.overrides.push_back(variation.key + "=" + value);
        longer.push_back(next);
      }
    cases = longer;
  }
  return cases;
}

std::string quoted(const std::string& text) {
  std::string inside;
  for (char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return fmt::format("'{}'", inside);
}

void write_jobs(const Sweep& sweep, const fs::path& folder) {
  std::string text;
  for (const auto& one : sweep.cases) {
    text += fmt::format("granrun run {} -o {} --resume", quoted(fs::absolute(sweep.scene).string()),
                        quoted(fs::absolute(folder / one.name).string()));
    for (const auto& override_text : one.overrides) text += fmt::format(" --set {}", quoted(override_text));
    text += "\n";
  }
  write_text_file(folder / "jobs.txt", text);
}

void write_summary(const Sweep& sweep, const fs::path& folder) {
  std::string text = "case,overrides,finished";
  for (const auto& column : history_columns()) text += fmt::format(",{}", column.name);
  text += "\n";
  for (const auto& one : sweep.cases) {
    const bool finished = is_finished(folder / one.name);
    std::string overrides;
    for (const auto& override_text : one.overrides)
      overrides += fmt::format("{}{}", overrides.empty() ? "" : " ", override_text);
    text += fmt::format("{},\"{}\",{}", one.name, overrides, finished ? 1 : 0);
    const Results results = finished ? summarise(read_history(folder / one.name / "history.csv")) : Results{};
    for (const auto& column : history_columns()) {
      text += ',';
      text += cell(results.mean(column.name), 9);
    }
    text += "\n";
  }
  write_text_file(folder / "sweep.csv", text);
}

/// Every case of the sweep, so that a mistake in the last is found before the first runs.
std::vector<Case> read_cases(const Sweep& sweep) {
  std::vector<Case> cases;
  std::vector<std::string> problems;
  for (const auto& one : sweep.cases) {
    try {
      cases.push_back(read_case(sweep.scene, one.overrides));
    } catch (const InputError& error) {
      for (const auto& problem : error.problems())
        problems.push_back(fmt::format("case {}: {}", one.name, problem));
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return cases;
}

}  // namespace

Sweep read_sweep(const fs::path& file) {
  auto document = TomlDocument::from_file(file);
  auto root = document.root();
  Sweep sweep;
  sweep.scene = root.table("sweep").file("scene", true);
  sweep.cases = combinations(read_variations(root));
  for (auto& table : root.tables("case"))
    sweep.cases.push_back({folder_name(table.string("name")), table.string_list("set", 1)});
  if (sweep.cases.empty()) document.problem("", "has no cases: add [[vary]] or [[case]]");
  std::set<std::string> names;
  for (const auto& one : sweep.cases)
    if (!names.insert(one.name).second)
      document.problem("", fmt::format("two cases are named {}: give their values other names", one.name));
  document.finish();
  return sweep;
}

int run_sweep(const fs::path& file, const fs::path& folder, bool list_only, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Sweep sweep = read_sweep(file);
  const std::vector<Case> cases = read_cases(sweep);
  write_jobs(sweep, folder);
  if (!options.quiet())
    fmt::print("{} cases; one command a line in {}\n", cases.size(), (folder / "jobs.txt").string());
  if (list_only) return exit_ok;
  int worst = exit_ok;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const fs::path where = folder / sweep.cases[k].name;
    if (is_finished(where)) continue;
    RunOptions one = options;
    one.resume = true;
    one.walltime_s -= std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    try {
      const int code = run_case(cases[k], where, one);
      if (code != exit_ok) return code;
    } catch (const NumericalError& error) {
      fmt::print(stderr, "case {}: {}\n", sweep.cases[k].name, error.what());
      worst = exit_numerical_failure;
    }
    write_summary(sweep, folder);
  }
  write_summary(sweep, folder);
  if (!options.quiet()) fmt::print("{}\n", (folder / "sweep.csv").string());
  return worst;
}

}  // namespace granrad
