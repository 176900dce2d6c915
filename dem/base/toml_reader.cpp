#include "dem/base/toml_reader.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/number_rule.h"
#include "dem/base/problem_list.h"
#include "dem/base/shortest_numbers.h"
#include "dem/base/suggestion.h"
#include "dem/base/units.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;

std::string join_path(std::string_view table, std::string_view key) {
  return table.empty() || key.empty() ? fmt::format("{}{}", table, key) : fmt::format("{}.{}", table, key);
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) throw IoError(fmt::format("{}: cannot be read", file.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A scalar as it stands in the file; "" for arrays and tables.
std::string value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  if (node.is_table() || node.is_array()) return "";
  std::ostringstream out;
  node.visit([&](const auto& concrete) { out << concrete; });
  return out.str();
}

std::string quoted_list(const std::vector<std::string>& words) {
  return words.empty() ? "" : fmt::format("\"{}\"", fmt::join(words, "\", \""));
}

Place place_of(const toml::source_region& source, const std::string& fallback_file) {
  return {source.path ? *source.path : fallback_file, source.begin.line, source.begin.column};
}

toml::table parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", name, error.source().begin.line, error.source().begin.column,
                                 error.description()));
  }
}

/// Moves everything of `from` into `into`; tables are merged, anything else is replaced.
void merge(toml::table& into, toml::table&& from) {
  for (auto&& [key, node] : from) {
    toml::table* existing = into.get_as<toml::table>(key);
    if (existing && node.is_table()) {
      merge(*existing, std::move(*node.as_table()));
    } else {
      into.erase(key.str());
      into.insert(key, std::move(node));
    }
  }
}

}  // namespace

struct TomlDocument::State {
  std::string name;
  fs::path folder;
  toml::table root;
  ProblemList problems;
  std::map<std::string, std::set<std::string>> known, read;      ///< keys asked for, by table path
  std::map<std::string, std::vector<std::string>> absent_needs;  ///< keys required of tables that are absent
  std::set<std::string> troubled;                                ///< paths that have a problem of their own

  void add(const Place& place, const std::string& path, std::string text) {
    problems.add(place, std::move(text));
    troubled.insert(path);
  }
  void add_at(const toml::node& node, const std::string& path, const std::string& why) {
    const std::string value = value_text(node);
    add(place_of(node.source(), name), path,
        why.starts_with("= ") ? fmt::format("{} {}", path, why)  // the caller shows the value
        : value.empty()       ? fmt::format("{}: {}", path, why)
                              : fmt::format("{} = {} ({})", path, value, why));
  }

  toml::node* find(std::string_view path, toml::node* start);
  void report_unread(const toml::table& table, const std::string& path);
  void report_unknown(const toml::key& key, const toml::node& node, const std::string& table_path);
  void report_absent_tables();
};

struct TomlTable::Node {
  TomlDocument::State* state;
  toml::table* table;  ///< null when the table is absent
  std::string path;

  toml::node* get(std::string_view key) {
    state->known[path].emplace(key);
    state->read[path].emplace(key);
    return table ? table->get(key) : nullptr;
  }
  std::string path_of(std::string_view key) const { return join_path(path, key); }

  void missing(std::string_view key, const std::string& expected) {
    if (!table) {
      state->absent_needs[path].emplace_back(key);
      return;
    }
    state->add(path.empty() ? Place{state->name} : place_of(table->source(), state->name), path_of(key),
               fmt::format("{} is missing: {}", path_of(key), expected));
  }

  double checked_number(const toml::node& node, const std::string& at, const NumberRule& rule) {
    double value = 0;
    std::string why_not, shown = value_text(node);
    if (const auto* text = node.as_string()) {
      const auto converted = quantity_in(text->get(), rule.unit, why_not);
      if (converted && std::string_view(rule.unit) != "1")
        shown += fmt::format(" = {:.10g} {}", *converted, rule.unit);
      value = converted.value_or(0);
    } else if (node.is_number()) {
      value = *node.value<double>();
    } else {
      why_not = "must be " + expected_number(rule);
    }
    if (why_not.empty() && !std::isfinite(value)) why_not = "must be a finite number";
    if (why_not.empty() && !inside(rule, value))
      why_not = fmt::format("must be {}{}{}", bounds_text(rule), *rule.why ? ": " : "", rule.why);
    if (why_not.empty()) return value;
    state->add(
        place_of(node.source(), state->name), at,
        shown.empty() ? fmt::format("{}: {}", at, why_not) : fmt::format("{} = {} ({})", at, shown, why_not));
    return placeholder(rule);
  }

  std::optional<Vec3> checked_vec3(const toml::node& node, const std::string& at, const NumberRule& rule) {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) {
      state->add_at(node, at, "must be three numbers, [x, y, z]");
      return std::nullopt;
    }
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = checked_number(*array->get(axis), fmt::format("{}[{}]", at, axis), rule);
    return v;
  }

  /// The array at `key`, with at least min_count entries; null (and a problem) otherwise.
  const toml::array* list(std::string_view key, std::size_t min_count, const std::string& of) {
    const toml::node* node = get(key);
    if (!node) {
      if (min_count > 0) missing(key, fmt::format("a list of at least {} {}", min_count, of));
      return nullptr;
    }
    const toml::array* array = node->as_array();
    if (array && array->size() >= min_count) return array;
    state->add_at(*node, path_of(key), fmt::format("must be a list of at least {} {}", min_count, of));
    return nullptr;
  }
};

// ---- document

TomlDocument::TomlDocument() : state_(std::make_unique<State>()) {}
TomlDocument::TomlDocument(TomlDocument&&) noexcept = default;
TomlDocument& TomlDocument::operator=(TomlDocument&&) noexcept = default;
TomlDocument::~TomlDocument() = default;

TomlDocument TomlDocument::from_string(std::string_view text, const std::string& name) {
  TomlDocument document;
  document.state_->name = name;
  document.state_->folder = fs::current_path();
  document.state_->root = parse_toml(text, name);
  return document;
}

TomlDocument TomlDocument::from_file(const fs::path& file) {
  TomlDocument document = from_string(read_text(file), file.string());
  document.state_->folder = fs::absolute(file).parent_path();
  return document;
}

TomlTable TomlDocument::root() {
  return TomlTable(std::make_shared<TomlTable::Node>(TomlTable::Node{state_.get(), &state_->root, ""}));
}

fs::path TomlDocument::folder() const {
  return state_->folder;
}

std::string TomlDocument::effective_text() const {
  std::ostringstream out;
  out << toml::toml_formatter(state_->root) << '\n';
  return with_shortest_numbers(out.str());
}

/// Follows "walls.y_min" or "polygon[2].role" from a table; null where it ends early.
toml::node* TomlDocument::State::find(std::string_view path, toml::node* node) {
  while (node && !path.empty()) {
    if (path.front() == '.') path.remove_prefix(1);
    if (path.front() == '[') {
      const auto close = path.find(']');
      if (close == path.npos || !node->is_array()) return nullptr;
      node = node->as_array()->get(std::strtoul(std::string(path.substr(1, close - 1)).c_str(), nullptr, 10));
      path.remove_prefix(close + 1);
    } else {
      const auto end = std::min(path.find_first_of(".["), path.size());
      node = node->is_table() ? node->as_table()->get(path.substr(0, end)) : nullptr;
      path.remove_prefix(end);
    }
  }
  return node;
}

void TomlDocument::problem(std::string_view path, std::string_view message) {
  const std::string at(path), why(message);
  if (path.empty()) return state_->add({state_->name}, "", why);
  if (const toml::node* node = state_->find(path, &state_->root)) return state_->add_at(*node, at, why);
  const auto dot = path.rfind('.');
  const toml::node* parent = dot == path.npos ? nullptr : state_->find(path.substr(0, dot), &state_->root);
  state_->add(parent ? place_of(parent->source(), state_->name) : Place{state_->name}, at,
              fmt::format("{}: {}", at, why));
}

void TomlDocument::override_value(std::string_view text) {
  const std::string name = std::string(override_mark) + std::string(text);
  const Place here{name};
  const auto equals = text.find('=');
  if (equals == text.npos || equals == 0)
    return state_->add(here, "", "must be key=value, for example radiation.rays=1000");
  std::string_view key = text.substr(0, equals);
  toml::table* into = &state_->root;
  if (const auto index_end = key.rfind(']'); index_end != key.npos) {
    toml::node* element = state_->find(key.substr(0, index_end + 1), into);
    if (!element || !element->is_table())
      return state_->add(here, "",
                         fmt::format("there is no [[{}]] in {}", key.substr(0, index_end + 1), state_->name));
    into = element->as_table();
    key.remove_prefix(std::min(index_end + 2, key.size()));
  }
  const std::string value(text.substr(equals + 1));
  std::string escaped;
  for (const char c : value) escaped += (c == '\\' || c == '"') ? fmt::format("\\{}", c) : std::string(1, c);
  for (const std::string& written : {value, fmt::format("\"{}\"", escaped)}) {
    try {
      return merge(*into, toml::parse(fmt::format("{}={}", key, written), name));
    } catch (const toml::parse_error&) {
    }
  }
  state_->add(here, "", "cannot be read as key=value");
}

void TomlDocument::State::report_unknown(const toml::key& key, const toml::node& node,
                                         const std::string& path) {
  const std::string name(key.str());
  const auto& siblings = known[path];
  const std::string meant = closest_word(name, {siblings.begin(), siblings.end()});
  const bool is_table = node.is_table();
  std::string text = is_table                    ? fmt::format("unknown table [{}]", join_path(path, name))
                     : node.is_array_of_tables() ? fmt::format("unknown table [[{}]]", join_path(path, name))
                     : path.empty()              ? fmt::format("unknown key '{}'", name)
                                                 : fmt::format("unknown key '{}' in [{}]", name, path);
  std::string home;
  for (const auto& [table, keys] : known)
    if (!table.empty() && keys.count(name)) home = table;
  if (!meant.empty())
    text += is_table ? fmt::format(". Did you mean [{}]?", join_path(path, meant))
                     : fmt::format(". Did you mean '{}'?", meant);
  else if (!home.empty() && home != path)
    text += fmt::format(". It is a key of [{}]", home);
  else if (!siblings.empty() && siblings.count(name) == 0)
    text += fmt::format(". Known here: {}", fmt::join(siblings, ", "));
  add(place_of(key.source(), this->name), join_path(path, name), text);
}

void TomlDocument::State::report_unread(const toml::table& table, const std::string& path) {
  for (auto&& [key, node] : table) {
    const std::string here = join_path(path, key.str());
    if (!read[path].count(std::string(key.str()))) {
      if (!troubled.count(here)) report_unknown(key, node, path);
      continue;
    }
    if (troubled.count(here) && read[here].empty()) continue;  // nobody could read it
    if (const auto* child = node.as_table()) report_unread(*child, here);
    if (const auto* array = node.as_array())
      for (std::size_t k = 0; k < array->size(); ++k)
        if (const auto* child = (*array)[k].as_table()) report_unread(*child, fmt::format("{}[{}]", here, k));
  }
}

void TomlDocument::State::report_absent_tables() {
  for (const auto& [path, keys] : absent_needs)
    add({name}, path, fmt::format("[{}] is missing; it needs {}", path, fmt::join(keys, ", ")));
  absent_needs.clear();
}

void TomlDocument::finish() {
  state_->report_unread(state_->root, "");
  state_->report_absent_tables();
  std::vector<std::string> lines = state_->problems.lines(state_->name);
  if (!lines.empty()) throw InputError(std::move(lines));
}

// ---- table

bool TomlTable::present() const {
  return node_->table;
}
std::string TomlTable::path() const {
  return node_->path;
}

bool TomlTable::has(std::string_view key) const {
  node_->state->known[node_->path].emplace(key);
  return node_->table && node_->table->contains(key);
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> all;
  if (node_->table)
    for (auto&& [key, value] : *node_->table) all.emplace_back(key.str());
  return all;
}

std::optional<double> TomlTable::optional_number(std::string_view key, const NumberRule& rule) {
  const toml::node* node = node_->get(key);
  if (!node) return std::nullopt;
  return node_->checked_number(*node, node_->path_of(key), rule);
}

double TomlTable::number(std::string_view key, const NumberRule& rule) {
  const auto value = optional_number(key, rule);
  if (!value) node_->missing(key, expected_number(rule));
  return value.value_or(placeholder(rule));
}

double TomlTable::number(std::string_view key, const NumberRule& rule, double fallback) {
  return optional_number(key, rule).value_or(fallback);
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t min, std::int64_t max,
                                std::optional<std::int64_t> fallback) {
  const std::int64_t allowed = std::clamp<std::int64_t>(fallback.value_or(min), min, max);
  const std::string expected = max == std::numeric_limits<std::int64_t>::max()
                                   ? fmt::format("an integer >= {}", min)
                                   : fmt::format("an integer in [{}, {}]", min, max);
  const toml::node* node = node_->get(key);
  if (!node) {
    if (!fallback) node_->missing(key, expected);
    return fallback.value_or(allowed);
  }
  std::optional<std::int64_t> value;
  if (const auto* whole = node->as_integer()) value = whole->get();
  if (const auto* real = node->as_floating_point(); real && std::abs(real->get()) < 9e15)
    if (real->get() == std::floor(real->get())) value = static_cast<std::int64_t>(real->get());
  if (value && *value >= min && *value <= max) return *value;
  node_->state->add_at(*node, node_->path_of(key), "must be " + expected);
  return allowed;
}

bool TomlTable::boolean(std::string_view key, std::optional<bool> fallback) {
  const toml::node* node = node_->get(key);
  if (!node) {
    if (!fallback) node_->missing(key, "true or false");
    return fallback.value_or(false);
  }
  if (const auto* value = node->as_boolean()) return value->get();
  node_->state->add_at(*node, node_->path_of(key), "must be true or false");
  return fallback.value_or(false);
}

std::string TomlTable::string(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = node_->get(key);
  if (!node) {
    if (!fallback) node_->missing(key, "a text in quotes");
    return fallback.value_or("");
  }
  if (const auto* value = node->as_string()) return value->get();
  node_->state->add_at(*node, node_->path_of(key), "must be a text in quotes");
  return fallback.value_or("");
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& allowed,
                              std::optional<std::string> fallback) {
  const std::string otherwise = fallback.value_or(allowed.front());
  const toml::node* node = node_->get(key);
  if (!node) {
    if (!fallback) node_->missing(key, "one of " + quoted_list(allowed));
    return otherwise;
  }
  const std::string value = node->value_or(std::string());
  if (node->is_string() && std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
  const std::string meant = node->is_string() ? closest_word(value, allowed) : "";
  const std::string hint = meant.empty() ? "" : fmt::format(". Did you mean \"{}\"?", meant);
  node_->state->add(place_of(node->source(), node_->state->name), node_->path_of(key),
                    fmt::format("{} = {} (must be one of {}){}", node_->path_of(key), value_text(*node),
                                quoted_list(allowed), hint));
  return otherwise;
}

fs::path TomlTable::file(std::string_view key, bool required) {
  const toml::node* node = node_->get(key);
  if (!node) {
    if (required) node_->missing(key, "the name of a file");
    return {};
  }
  const auto* name = node->as_string();
  const fs::path path = name ? (node_->state->folder / name->get()).lexically_normal() : fs::path();
  if (name && fs::is_regular_file(path)) return path;
  node_->state->add_at(*node, node_->path_of(key),
                       name ? fmt::format("no such file: {}", path.string()) : "must be the name of a file");
  return {};
}

Vec3 TomlTable::vec3(std::string_view key, const NumberRule& each, std::optional<Vec3> fallback) {
  const double any = placeholder(each);
  const Vec3 otherwise = fallback.value_or(Vec3{any, any, any});
  if (const toml::node* node = node_->get(key))
    return node_->checked_vec3(*node, node_->path_of(key), each).value_or(otherwise);
  if (!fallback) node_->missing(key, "three numbers, [x, y, z]");
  return otherwise;
}

std::vector<Vec3> TomlTable::vec3_list(std::string_view key, const NumberRule& each, std::size_t min_count) {
  std::vector<Vec3> all;
  if (const toml::array* array = node_->list(key, min_count, "points [x, y, z]"))
    for (std::size_t k = 0; k < array->size(); ++k)
      all.push_back(node_->checked_vec3((*array)[k], fmt::format("{}[{}]", node_->path_of(key), k), each)
                        .value_or(Vec3{}));
  return all;
}

std::vector<double> TomlTable::number_list(std::string_view key, const NumberRule& each,
                                           std::size_t min_count) {
  std::vector<double> all;
  if (const toml::array* array = node_->list(key, min_count, "numbers"))
    for (std::size_t k = 0; k < array->size(); ++k)
      all.push_back(node_->checked_number((*array)[k], fmt::format("{}[{}]", node_->path_of(key), k), each));
  return all;
}

std::vector<std::string> TomlTable::string_list(std::string_view key, std::size_t min_count) {
  std::vector<std::string> all;
  if (const toml::array* array = node_->list(key, min_count, "texts in quotes"))
    for (std::size_t k = 0; k < array->size(); ++k) {
      if (const auto* text = (*array)[k].as_string())
        all.push_back(text->get());
      else
        node_->state->add_at((*array)[k], fmt::format("{}[{}]", node_->path_of(key), k),
                             "must be a text in quotes");
    }
  return all;
}

void TomlTable::add_keys_from_file(std::string_view key) {
  const fs::path from = file(key, false);
  if (from.empty()) return;
  toml::table loaded = parse_toml(read_text(from), from.string());
  for (auto&& [name, value] : loaded)
    if (!node_->table->contains(name.str())) node_->table->insert(name, std::move(value));
}

TomlTable TomlTable::table(std::string_view key) {
  toml::node* node = node_->get(key);
  if (node && !node->is_table()) node_->state->add_at(*node, node_->path_of(key), "must be a table");
  return TomlTable(
      std::make_shared<Node>(Node{node_->state, node ? node->as_table() : nullptr, node_->path_of(key)}));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  std::vector<TomlTable> all;
  toml::node* node = node_->get(key);
  toml::array* array = node ? node->as_array() : nullptr;
  if (node && !node->is_array_of_tables() && !(array && array->empty()))
    node_->state->add_at(*node, node_->path_of(key),
                         fmt::format("must be written as [[{}]]", node_->path_of(key)));
  else if (array)
    for (std::size_t k = 0; k < array->size(); ++k)
      all.push_back(TomlTable(std::make_shared<Node>(
          Node{node_->state, (*array)[k].as_table(), fmt::format("{}[{}]", node_->path_of(key), k)})));
  return all;
}

void TomlTable::problem(std::string_view key, std::string_view message) {
  node_->state->known[node_->path].emplace(key);
  const toml::node* node = node_->table ? (key.empty() ? node_->table : node_->table->get(key)) : nullptr;
  if (node) return node_->state->add_at(*node, node_->path_of(key), std::string(message));
  const Place place = node_->table && !node_->path.empty()
                          ? place_of(node_->table->source(), node_->state->name)
                          : Place{node_->state->name};
  node_->state->add(place, node_->path_of(key), fmt::format("{}: {}", node_->path_of(key), message));
}

}  // namespace granrad
