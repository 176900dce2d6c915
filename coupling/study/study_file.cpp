#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "coupling/study/study.h"
#include "coupling/study/study_outputs.h"
#include "dem/base/error.h"
#include "dem/base/toml/toml_reader.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

std::string folder_name(const std::string& text) {
  std::string name;
  for (char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_' ? c : '_';
  return name == "." || name == ".." ? "_" : name;
}

std::string last_part(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

std::string joined(const std::string& a, const std::string& b, char with) {
  return a.empty() ? b : b.empty() ? a : a + with + b;
}

/// One value of one [[vary]].
struct Step {
  std::string name;
  std::vector<std::string> set;
  std::vector<std::pair<std::string, std::string>> varied;
  bool quick = true;
};

/// [[vary]] as it stands in the file.
struct Vary {
  std::vector<std::string> keys, texts, values, names;
  std::vector<std::vector<std::string>> set;
  std::string name;
};

Vary read_vary(TomlTable& table) {
  Vary vary;
  const auto key = table.string(
      {"key", "key of the scene that takes each of the values", "required without keys and set"}, "");
  vary.keys = table.string_list({"keys", "keys that take the same value, in place of key"});
  if (!key.empty()) vary.keys.push_back(key);
  vary.values = table.value_list({"values", "what the key takes, one after the other"});
  vary.texts = table.string_list({"texts", "the same as they would stand behind --set KEY="});
  vary.set = table.string_lists({"set", "in place of key and values: rows of KEY=VALUE, set together"});
  vary.names = table.string_list({"names", "of the rows of set: a column, and part of the names of cases"});
  vary.name = table.string(
      {"name", "heads the column; stands before the value in names of cases", "last part of the key; row"},
      "");
  return vary;
}

std::vector<Step> rows_of(TomlTable& table, const Vary& vary) {
  if (vary.names.size() != vary.set.size())
    table.problem("names",
                  fmt::format("has {} names for {} rows of set", vary.names.size(), vary.set.size()));
  for (const char* other : {"key", "keys", "values", "texts"})
    if (table.has(other)) table.problem(other, "stands beside set; use one or the other");
  const std::string column = vary.name.empty() ? "row" : vary.name;
  std::vector<Step> steps;
  for (std::size_t k = 0; k < std::min(vary.set.size(), vary.names.size()); ++k) {
    Step step{folder_name(vary.names[k]), vary.set[k], {{column, vary.names[k]}}};
    for (const auto& text : vary.set[k])
      if (const auto equals = text.find('='); equals != std::string::npos)
        step.varied.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    steps.push_back(step);
  }
  return steps;
}

std::vector<Step> read_steps(TomlTable& table) {
  const Vary vary = read_vary(table);
  if (!vary.set.empty()) return rows_of(table, vary);
  if (vary.keys.empty())
    table.problem("key", "missing: name the key of the scene that varies, or rows by set");
  if (vary.values.empty() && vary.texts.empty()) table.problem("values", "missing: list what the key takes");
  if (vary.keys.empty()) return {};
  const std::string name = vary.name.empty() ? last_part(vary.keys.front()) : vary.name;
  std::vector<Step> steps;
  for (const auto* list : {&vary.texts, &vary.values})
    for (const auto& value : *list) {
      Step step{folder_name(fmt::format("{}-{}", name, value)), {}, {}};
      for (const auto& key : vary.keys) {
        step.set.push_back(fmt::format("{}={}", key, value));
        step.varied.emplace_back(key, value);
      }
      steps.push_back(step);
    }
  return steps;
}

std::vector<Step> read_marked_steps(TomlTable& table) {
  auto steps = read_steps(table);
  const auto quick =
      table.string_list({"quick", "the steps a quick run takes, by the names of their cases", "all"});
  if (!table.has("quick")) return steps;
  for (const auto& name : quick)
    if (std::none_of(steps.begin(), steps.end(), [&](const Step& s) { return s.name == name; }))
      table.problem("quick", fmt::format("names {}, which is none of its steps", name));
  for (auto& step : steps) step.quick = std::find(quick.begin(), quick.end(), step.name) != quick.end();
  return steps;
}

/// Keys that a group and a single case share; what the case lacks is the group's.
StudyCase read_base(TomlTable& table, const StudyCase& outer) {
  StudyCase base = outer;
  base.kind = table.choice(
      {"kind",
       "run, validate, measure (conductivity), trace (frames of runs), fit (traces); command: options are a "
       "program with its words, {folder} is the folder of the case",
       "of the group; run"},
      study_kinds, outer.kind);
  if (const auto scene = table.file({"scene", "scene every case starts from", "of the group"}, false);
      table.has("scene"))
    base.scene = scene;
  for (const auto& text : table.string_list({"set", "settings KEY=VALUE, as --set of granrun run"}))
    base.set.push_back(text);
  for (const auto& key : table.string_list({"unset", "keys taken out of the scene before"}))
    base.unset.push_back(key);
  const auto from =
      table.string_list({"from", "cases a trace takes its frames from, a fit its traces", "of the group"});
  if (table.has("from")) base.from = from;
  const auto options = table.string_list({"options", "further words of the command", "of the group"});
  if (table.has("options")) base.options = options;
  base.start = table.string({"start", "of a run: begins with the last frame of this case", "of the group"},
                            outer.start);
  base.quick = table.boolean({"quick", "part of a quick run (granrun study --quick)", "of the group; false"},
                             outer.quick);
  for (const auto& text :
       table.string_list({"quick_set", "further settings KEY=VALUE of a quick run, made last"}))
    base.quick_set.push_back(text);
  return base;
}

/// Replicates over seeds: one case each, of one point.
void add_case(std::vector<StudyCase>& cases, StudyCase one, const std::string& name,
              const std::vector<std::string>& seeds, const std::string& seed_key) {
  one.point = joined(one.group, name, '/');
  one.name = one.point;
  if (seeds.empty()) return cases.push_back(one);
  for (const auto& seed : seeds) {
    StudyCase replicate = one;
    replicate.name = fmt::format("{}_seed-{}", one.point, folder_name(seed));
    replicate.set.push_back(fmt::format("{}={}", seed_key, seed));
    cases.push_back(replicate);
  }
}

/// `table` holds the seeds of the group, `lists` its [[vary]] and [[case]].
void read_group(TomlTable table, TomlTable lists, const StudyCase& base, std::vector<StudyCase>& cases) {
  const auto seeds = table.value_list({"seeds", "replicates of every case, averaged"});
  const auto seed_key = table.string({"seed_key", "key of the scene that takes the seeds"}, "feed.seed");
  std::vector<std::pair<std::string, StudyCase>> points;
  for (auto& vary : lists.tables({"vary", "Keys that vary; every combination of all [[vary]] is a case"})) {
    if (points.empty()) points.emplace_back("", base);
    std::vector<std::pair<std::string, StudyCase>> longer;
    const auto steps = read_marked_steps(vary);
    for (const auto& [name, shorter] : points)
      for (const auto& step : steps) {
        StudyCase next = shorter;
        next.set.insert(next.set.end(), step.set.begin(), step.set.end());
        next.varied.insert(next.varied.end(), step.varied.begin(), step.varied.end());
        next.quick = next.quick && step.quick;
        longer.emplace_back(joined(name, step.name, '_'), next);
      }
    points = longer;
  }
  for (const auto& [name, point] : points) add_case(cases, point, name, seeds, seed_key);
  for (auto& one : lists.tables({"case", "A single case beside the combinations"})) {
    const std::string name = folder_name(one.string({"name", "of the case and its folder"}));
    add_case(cases, read_base(one, base), name, seeds, seed_key);
  }
}

void check_names(const Study& study, TomlDocument& document) {
  std::set<std::string> names, points;
  if (study.cases.empty()) document.problem("", "has no cases: add [[vary]] or [[case]]");
  for (const auto& one : study.cases) {
    points.insert(one.point);
    if (!names.insert(one.name).second)
      document.problem("", fmt::format("two cases are named {}: give their values other names", one.name));
    if (one.scene.empty() && one.kind != StudyKind::trace && one.kind != StudyKind::fit &&
        one.kind != StudyKind::command)
      document.problem(
          "", fmt::format("case {} has no scene: name one in [study], its group or the case", one.name));
  }
  for (const auto& one : study.cases) {
    std::vector<std::string> needs = one.from;
    if (!one.start.empty()) needs.push_back(one.start);
    for (const auto& need : needs)
      if (!points.count(need) || need == one.point)
        document.problem("", fmt::format("case {} needs {}, which is no other case", one.name, need));
  }
}

}  // namespace

std::vector<const StudyCase*> Study::of_point(const std::string& point) const {
  std::vector<const StudyCase*> found;
  for (const auto& one : cases)
    if (one.point == point) found.push_back(&one);
  return found;
}

Study read_study(TomlDocument& document, const fs::path& file, bool quick) {
  auto root = document.root();
  Study study;
  study.file = fs::absolute(file);
  auto head = root.table({"study", "The study, and what all its cases share"});
  if (root.has("sweep")) head = root.table({"sweep", "The old name of [study]: the same keys"});
  study.title = head.string({"title", "of the page", "name of the file"}, file.stem().string());
  const StudyCase base = read_base(head, {});
  read_group(head, root, base, study.cases);
  for (auto& group :
       root.tables({"group", "Further cases, with another scene or kind; what it lacks is the study's"})) {
    StudyCase outer = base;
    outer.group = folder_name(group.string({"name", "stands before the names of its cases"}));
    read_group(group, group, read_base(group, outer), study.cases);
  }
  read_outputs(root, study);
  for (auto& one : study.cases) {
    one.skipped = quick && !one.quick;
    if (quick) one.set.insert(one.set.end(), one.quick_set.begin(), one.quick_set.end());
  }
  check_names(study, document);
  document.finish();
  return study;
}

Study read_study(const fs::path& file, bool quick) {
  auto document = TomlDocument::from_file(file);
  return read_study(document, file, quick);
}

}  // namespace granrad
