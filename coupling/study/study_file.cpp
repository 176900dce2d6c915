#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "coupling/study/study.h"
#include "dem/base/error.h"
#include "dem/base/toml/toml_reader.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kinds = {"run", "validate", "measure", "trace", "fit", "command"};

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

std::vector<Step> read_rows(TomlTable& table) {
  const auto rows = table.string_lists("set", 1);
  const auto names = table.string_list("names", rows.size());
  if (!names.empty() && names.size() != rows.size())
    table.problem("names", fmt::format("has {} names for {} rows of set", names.size(), rows.size()));
  const std::string column = table.string("name", "row");
  std::vector<Step> steps;
  for (std::size_t k = 0; k < std::min(rows.size(), names.size()); ++k) {
    Step step{folder_name(names[k]), rows[k], {{column, names[k]}}};
    for (const auto& text : rows[k])
      if (const auto equals = text.find('='); equals != std::string::npos)
        step.varied.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    steps.push_back(step);
  }
  return steps;
}

std::vector<Step> read_steps(TomlTable& table) {
  if (table.has("set")) return read_rows(table);
  std::vector<std::string> keys;
  if (table.has("keys")) keys = table.string_list("keys", 1);
  if (keys.empty() || table.has("key")) keys.push_back(table.string("key"));
  std::vector<std::string> values;
  if (table.has("texts")) values = table.string_list("texts", 1);
  if (!table.has("texts") || table.has("values"))
    for (const auto& value : table.value_list("values", 1)) values.push_back(value);
  const std::string name = table.string("name", last_part(keys.front()));
  std::vector<Step> steps;
  for (const auto& value : values) {
    Step step{folder_name(name + "-" + value), {}, {}};
    for (const auto& key : keys) {
      step.set.push_back(key + "=" + value);
      step.varied.emplace_back(key, value);
    }
    steps.push_back(step);
  }
  return steps;
}

std::vector<Step> read_marked_steps(TomlTable& table) {
  auto steps = read_steps(table);
  if (!table.has("quick")) return steps;
  const auto quick = table.string_list("quick");
  for (const auto& name : quick)
    if (std::none_of(steps.begin(), steps.end(), [&](const Step& s) { return s.name == name; }))
      table.problem("quick", fmt::format("names {}, which is none of its steps", name));
  for (auto& step : steps) step.quick = std::find(quick.begin(), quick.end(), step.name) != quick.end();
  return steps;
}

StudyKind kind_of(const std::string& name) {
  return static_cast<StudyKind>(std::find(kinds.begin(), kinds.end(), name) - kinds.begin());
}

/// Keys that a group and a single case share; what the case lacks is the group's.
StudyCase read_base(TomlTable& table, const StudyCase& outer) {
  StudyCase base = outer;
  base.kind = kind_of(table.choice("kind", kinds, to_string(outer.kind)));
  if (table.has("scene")) base.scene = table.file("scene", true);
  for (const auto& text : table.string_list("set")) base.set.push_back(text);
  for (const auto& key : table.string_list("unset")) base.unset.push_back(key);
  if (table.has("from")) base.from = table.string_list("from", 1);
  if (table.has("options")) base.options = table.string_list("options");
  base.start = table.string("start", outer.start);
  base.quick = table.boolean("quick", outer.quick);
  for (const auto& text : table.string_list("quick_set")) base.quick_set.push_back(text);
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
    replicate.set.push_back(seed_key + "=" + seed);
    cases.push_back(replicate);
  }
}

/// `table` holds the seeds of the group, `lists` its [[vary]] and [[case]].
void read_group(TomlTable table, TomlTable lists, const StudyCase& base, std::vector<StudyCase>& cases) {
  const auto seeds = table.has("seeds") ? table.value_list("seeds", 1) : std::vector<std::string>{};
  const auto seed_key = table.string("seed_key", "feed.seed");
  std::vector<std::pair<std::string, StudyCase>> points;
  for (auto& vary : lists.tables("vary")) {
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
  for (auto& one : lists.tables("case")) {
    const std::string name = folder_name(one.string("name"));
    add_case(cases, read_base(one, base), name, seeds, seed_key);
  }
}

StudyFigure read_figure(TomlTable table) {
  StudyFigure figure;
  figure.title = table.string("title");
  figure.text = table.string("text", "");
  figure.x = table.string("x");
  figure.y = table.string_list("y", 1);
  figure.x_label = table.string("x_label", figure.x);
  figure.y_label = table.string("y_label", figure.y.empty() ? "" : figure.y.front());
  figure.groups = table.string_list("groups");
  figure.history = table.string_list("history");
  figure.particles = table.string_list("particles");
  figure.by = table.string("by", "");
  figure.log_x = table.boolean("log_x", false);
  figure.log_y = table.boolean("log_y", false);
  for (auto& curve : table.tables("curve"))
    figure.curves.push_back({curve.string("label"), curve.string("formula")});
  return figure;
}

StudyFit read_fit(TomlTable table) {
  StudyFit fit;
  fit.name = table.string("name");
  fit.x = table.string("x");
  fit.y = table.string("y");
  fit.form = table.choice("form", {"power", "line", "logarithm", "exponential_logarithm"});
  fit.group = table.string("group", "");
  fit.x_min = table.number("x_min", {}, 0);
  fit.x_max = table.number("x_max", {}, 0);
  return fit;
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

const char* to_string(StudyKind kind) {
  return kinds[static_cast<std::size_t>(kind)].c_str();
}

std::vector<const StudyCase*> Study::of_point(const std::string& point) const {
  std::vector<const StudyCase*> found;
  for (const auto& one : cases)
    if (one.point == point) found.push_back(&one);
  return found;
}

Study read_study(const fs::path& file, bool quick) {
  auto document = TomlDocument::from_file(file);
  auto root = document.root();
  Study study;
  study.file = fs::absolute(file);
  auto head = root.has("sweep") ? root.table("sweep") : root.table("study");
  study.title = head.string("title", file.stem().string());
  const StudyCase base = read_base(head, {});
  read_group(head, root, base, study.cases);
  for (auto& group : root.tables("group")) {
    StudyCase outer = base;
    outer.group = folder_name(group.string("name"));
    read_group(group, group, read_base(group, outer), study.cases);
  }
  for (auto& column : root.tables("column"))
    study.columns.push_back({column.string("name"), column.string("formula")});
  for (auto& fit : root.tables("fit")) study.fits.push_back(read_fit(fit));
  for (auto& figure : root.tables("figure")) study.figures.push_back(read_figure(figure));
  if (auto claims = root.table("claims"); claims.present()) study.claims = claims.file("file", true);
  for (auto& one : study.cases) {
    one.skipped = quick && !one.quick;
    if (quick) one.set.insert(one.set.end(), one.quick_set.begin(), one.quick_set.end());
  }
  check_names(study, document);
  document.finish();
  return study;
}

}  // namespace granrad
