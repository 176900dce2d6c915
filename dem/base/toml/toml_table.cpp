#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/files/data_folder.h"
#include "dem/base/suggestion.h"
#include "dem/base/toml/toml_reader_state.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

std::string quoted_text(const std::string& text) {
  std::string inside = "\"";
  for (const char c : text) {
    if (c == '\\' || c == '"') inside += '\\';
    inside += c;
  }
  return inside += '"';
}

/// A default as TOML; nothing where it only stands for "worked out later" (outside the rule and explained).
std::optional<std::string> number_text(double value, const NumberRule& rule, const Key& key) {
  if (!inside(rule, value) && !key.otherwise.empty()) return std::nullopt;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

}  // namespace

bool TomlTable::present() const {
  return node_->table || node_->exploring(Exploration::tables);
}
std::int64_t TomlTable::line() const {
  return node_->table ? static_cast<std::int64_t>(node_->table->source().begin.line) : 0;
}

std::string TomlTable::path() const {
  return node_->path;
}

bool TomlTable::has(std::string_view key) const {
  node_->state->known[node_->path].emplace(key);
  if (node_->state->exploring) {
    node_->state->asked_for.insert(node_->path_of(key));
    return node_->exploring(Exploration::keys);
  }
  return node_->table && node_->table->contains(key);
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> all;
  if (node_->exploring(Exploration::keys)) all.emplace_back("NAME");
  if (node_->table)
    for (auto&& [key, value] : *node_->table) all.emplace_back(key.str());
  return all;
}

std::optional<double> TomlTable::optional_number(const Key& key, const NumberRule& rule) {
  node_->use(key, KeyKind::number, rule);
  const toml::node* node = node_->get(key.name);
  if (node) return node_->checked_number(*node, node_->path_of(key.name), rule);
  if (node_->exploring(Exploration::keys)) return placeholder(rule);
  return std::nullopt;
}

double TomlTable::number(const Key& key, const NumberRule& rule) {
  node_->use(key, KeyKind::number, rule, true);
  const toml::node* node = node_->get(key.name);
  if (node) return node_->checked_number(*node, node_->path_of(key.name), rule);
  node_->missing(key.name, expected_number(rule));
  return placeholder(rule);
}

double TomlTable::number(const Key& key, const NumberRule& rule, double fallback) {
  node_->use(key, KeyKind::number, rule).fallback = number_text(fallback, rule, key);
  const toml::node* node = node_->get(key.name);
  return node ? node_->checked_number(*node, node_->path_of(key.name), rule) : fallback;
}

std::optional<double> TomlTable::number_or_auto(const Key& key, const NumberRule& rule, double fallback,
                                                bool automatic) {
  KeyUse& use = node_->use(key, KeyKind::number, rule);
  use.choices = {"auto"};
  use.fallback = automatic ? quoted_text("auto") : number_text(fallback, rule, key);
  const toml::node* node = node_->get(key.name);
  if (!node) return automatic ? std::nullopt : std::optional(fallback);
  if (const auto* word = node->as_string(); word && word->get() == "auto") return std::nullopt;
  return node_->checked_number(*node, node_->path_of(key.name), rule);
}

std::int64_t TomlTable::integer(const Key& key, std::int64_t min, std::int64_t max,
                                std::optional<std::int64_t> fallback) {
  const bool bounded = max < std::numeric_limits<std::int32_t>::max();
  KeyUse& use = node_->use(
      key, KeyKind::integer,
      {.min = static_cast<double>(min), .max = bounded ? static_cast<double>(max) : infinity}, !fallback);
  if (fallback) use.fallback = fmt::format("{}", *fallback);
  const std::int64_t allowed = std::clamp<std::int64_t>(fallback.value_or(min), min, max);
  const std::string expected = max == std::numeric_limits<std::int64_t>::max()
                                   ? fmt::format("an integer >= {}", min)
                                   : fmt::format("an integer in [{}, {}]", min, max);
  const toml::node* node = node_->get(key.name);
  if (!node) {
    if (!fallback) node_->missing(key.name, expected);
    return fallback.value_or(allowed);
  }
  std::optional<std::int64_t> value;
  if (const auto* whole = node->as_integer()) value = whole->get();
  if (const auto* real = node->as_floating_point(); real && std::abs(real->get()) < 9e15)
    if (real->get() == std::floor(real->get())) value = static_cast<std::int64_t>(real->get());
  if (value && *value >= min && *value <= max) return *value;
  node_->state->add_at(*node, node_->path_of(key.name), "must be " + expected);
  return allowed;
}

bool TomlTable::boolean(const Key& key, std::optional<bool> fallback) {
  KeyUse& use = node_->use(key, KeyKind::boolean, {}, !fallback);
  use.choices = {"true", "false"};
  if (fallback) use.fallback = *fallback ? "true" : "false";
  const bool otherwise = node_->picked(key).value_or(fallback.value_or(false) ? "true" : "false") == "true";
  use.value = otherwise ? "true" : "false";
  const toml::node* node = node_->get(key.name);
  if (!node) {
    if (!fallback) node_->missing(key.name, "true or false");
    return otherwise;
  }
  if (const auto* value = node->as_boolean()) return value->get();
  node_->state->add_at(*node, node_->path_of(key.name), "must be true or false");
  return otherwise;
}

std::string TomlTable::string(const Key& key, std::optional<std::string> fallback) {
  KeyUse& use = node_->use(key, KeyKind::text, {}, !fallback);
  if (fallback) use.fallback = quoted_text(*fallback);
  const toml::node* node = node_->get(key.name);
  if (!node) {
    if (!fallback) node_->missing(key.name, "a text in quotes");
    return fallback.value_or("");
  }
  if (const auto* value = node->as_string()) return value->get();
  node_->state->add_at(*node, node_->path_of(key.name), "must be a text in quotes");
  return fallback.value_or("");
}

std::string TomlTable::choice(const Key& key, const std::vector<std::string>& allowed,
                              std::optional<std::string> fallback) {
  KeyUse& use = node_->use(key, KeyKind::choice, {}, !fallback);
  use.choices = allowed;
  if (fallback) use.fallback = quoted_text(*fallback);
  const std::string otherwise = node_->picked(key).value_or(fallback.value_or(allowed.front()));
  use.value = otherwise;
  const toml::node* node = node_->get(key.name);
  if (!node) {
    if (!fallback) node_->missing(key.name, "one of " + quoted_list(allowed));
    return otherwise;
  }
  const std::string value = node->value_or(std::string());
  if (node->is_string() && std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
  const std::string meant = node->is_string() ? closest_word(value, allowed) : "";
  const std::string hint = meant.empty() ? "" : fmt::format(". Did you mean \"{}\"?", meant);
  node_->state->add(place_of(node->source(), node_->state->name), node_->path_of(key.name),
                    fmt::format("{} = {} (must be one of {}){}", node_->path_of(key.name), value_text(*node),
                                quoted_list(allowed), hint));
  return otherwise;
}

fs::path TomlTable::file(const Key& key, bool required) {
  node_->use(key, KeyKind::file, {}, required);
  const toml::node* node = node_->get(key.name);
  if (!node) {
    if (required) node_->missing(key.name, "the name of a file");
    return {};
  }
  const auto* name = node->as_string();
  if (!name) {
    node_->state->add_at(*node, node_->path_of(key.name), "must be the name of a file");
    return {};
  }
  const fs::path beside = (node_->state->folder / name->get()).lexically_normal();
  fs::path& found = node_->state->files[node_->path_of(key.name)];
  // What --set names lies, first of all, where the command is given.
  const bool given_in_shell = node->source().path && node->source().path->starts_with(override_mark);
  const fs::path here = fs::absolute(name->get()).lexically_normal();
  found = given_in_shell && fs::is_regular_file(here) ? here
          : fs::is_regular_file(beside)               ? beside
                                                      : installed_file(name->get());
  if (!found.empty()) return found;
  node_->state->files.erase(node_->path_of(key.name));
  node_->state->add_at(*node, node_->path_of(key.name), fmt::format("no such file: {}", beside.string()));
  return {};
}

fs::path TomlTable::pattern(const Key& key) {
  const std::string text = string(key, "");
  if (text.empty()) return {};
  return node_->state->patterns[node_->path_of(key.name)] =
             (fs::absolute(node_->state->folder) / text).lexically_normal();
}

Vec3 TomlTable::vec3(const Key& key, const NumberRule& each, std::optional<Vec3> fallback) {
  KeyUse& use = node_->use(key, KeyKind::vector, each, !fallback);
  if (fallback) use.fallback = fmt::format("[{}, {}, {}]", fallback->x, fallback->y, fallback->z);
  const double any = placeholder(each);
  const Vec3 otherwise = fallback.value_or(Vec3{any, any, any});
  if (const toml::node* node = node_->get(key.name))
    return node_->checked_vec3(*node, node_->path_of(key.name), each).value_or(otherwise);
  if (!fallback) node_->missing(key.name, "three numbers, [x, y, z]");
  return otherwise;
}

void TomlTable::add_keys_from_file(const Key& key) {
  const fs::path from = file(key, false);
  if (from.empty()) return;
  toml::table loaded = parse_toml_file(from);
  for (auto&& [name, value] : loaded)
    if (!node_->table->contains(name.str())) node_->table->insert(name, std::move(value));
}

TomlTable TomlTable::table(const Key& key) {
  node_->use(key, KeyKind::table);
  toml::node* node = node_->get(key.name);
  if (node && !node->is_table()) node_->state->add_at(*node, node_->path_of(key.name), "must be a table");
  return TomlTable(
      std::make_shared<Node>(Node{node_->state, node ? node->as_table() : nullptr, node_->path_of(key.name),
                                  join_path(node_->shown, key.shown)}));
}

std::vector<TomlTable> TomlTable::tables(const Key& key) {
  node_->use(key, KeyKind::tables);
  std::vector<TomlTable> all;
  const std::string at = node_->path_of(key.name), shown = join_path(node_->shown, key.shown);
  toml::node* node = node_->get(key.name);
  toml::array* array = node ? node->as_array() : nullptr;
  if (node_->exploring(Exploration::tables))
    all.push_back(TomlTable(std::make_shared<Node>(Node{node_->state, nullptr, at + "[0]", shown})));
  if (node && !node->is_array_of_tables() && !(array && array->empty()))
    node_->state->add_at(*node, at, fmt::format("must be written as [[{}]]", at));
  else if (array)
    for (std::size_t k = 0; k < array->size(); ++k)
      all.push_back(TomlTable(std::make_shared<Node>(
          Node{node_->state, (*array)[k].as_table(), fmt::format("{}[{}]", at, k), shown})));
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
