#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/suggestion.h"
#include "dem/base/toml/shortest_numbers.h"
#include "dem/base/toml/stray_character.h"
#include "dem/base/toml/toml_reader_state.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

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
  TomlDocument document;
  document.state_->name = file.string();
  document.state_->root = parse_toml_file(file);
  document.state_->folder = fs::absolute(file).parent_path();
  return document;
}

TomlDocument TomlDocument::exploring(const Exploration& how) {
  TomlDocument document;
  document.state_->exploring = &how;
  return document;
}

TomlTable TomlDocument::root() {
  return TomlTable(std::make_shared<TomlTable::Node>(TomlTable::Node{state_.get(), &state_->root, "", ""}));
}

const std::vector<KeyUse>& TomlDocument::uses() const {
  return state_->uses;
}

fs::path TomlDocument::folder() const {
  return state_->folder;
}

std::string TomlDocument::effective_text(const std::map<std::string, std::string>& texts) const {
  toml::table shown = state_->root;
  for (const auto& [path, text] : texts)
    if (toml::node* node = state_->find(path, &shown); node && node->is_string()) *node->as_string() = text;
  std::ostringstream out;
  out << toml::toml_formatter(shown) << '\n';
  return with_shortest_numbers(out.str());
}

namespace {

/// The table a path names, made where it is missing.
toml::table& table_at(toml::table& root, toml::node* found, const std::string& path) {
  if (found && found->is_table()) return *found->as_table();
  toml::table* here = &root;
  for (std::size_t from = 0; from < path.size();) {
    const auto dot = std::min(path.find('.', from), path.size());
    const std::string part = path.substr(from, dot - from);
    here->insert(part, toml::table{});
    here = (*here)[part].as_table();
    from = dot + 1;
  }
  return *here;
}

bool lists_are_there(const KeyUse& use, const toml::node* found) {
  return found || use.at.find('[') == std::string::npos;
}

}  // namespace

std::string TomlDocument::text_with_defaults() const {
  toml::table all = state_->root;
  std::set<std::string> added;
  for (const KeyUse& use : state_->uses) {
    if (use.given || !use.fallback || use.name.empty()) continue;
    toml::node* found = state_->find(use.at, &all);
    if (!lists_are_there(use, found) || (found && !found->is_table())) continue;
    toml::table& into = table_at(all, found, use.at);
    if (into.contains(use.name)) continue;
    toml::table parsed = toml::parse(fmt::format("x = {}", *use.fallback));
    into.insert(use.name, std::move(*parsed.get("x")));
    added.insert(join_path(use.at, use.name));
  }
  std::ostringstream out;
  out << toml::toml_formatter(all) << '\n';
  std::istringstream lines(with_shortest_numbers(out.str()));
  std::string text, section;
  std::map<std::string, int> lists;
  for (std::string line; std::getline(lines, line);) {
    const auto start = line.find_first_not_of(' ');
    const std::string bare = start == std::string::npos ? "" : line.substr(start);
    if (bare.starts_with("[[") && bare.ends_with("]]")) {
      const std::string name = bare.substr(2, bare.size() - 4);
      section = fmt::format("{}[{}]", name, lists[name]++);
    } else if (bare.starts_with("[") && bare.ends_with("]")) {
      section = bare.substr(1, bare.size() - 2);
    }
    const auto equals = bare.find(" = ");
    const bool fallback =
        equals != std::string::npos && added.count(join_path(section, bare.substr(0, equals)));
    text += fallback ? fmt::format("{}# {}\n", line.substr(0, start), bare) : line + '\n';
  }
  return text;
}

const std::map<std::string, fs::path>& TomlDocument::files() const {
  return state_->files;
}

const std::map<std::string, fs::path>& TomlDocument::patterns() const {
  return state_->patterns;
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

void TomlDocument::remove_key(std::string_view path) {
  const auto dot = path.rfind('.');
  toml::node* parent = dot == path.npos ? &state_->root : state_->find(path.substr(0, dot), &state_->root);
  toml::table* table = parent ? parent->as_table() : nullptr;
  if (!table || !table->contains(path.substr(dot + 1)))
    return state_->add({state_->name}, "", fmt::format("unset {}: there is no such key", path));
  table->erase(path.substr(dot + 1));
}

namespace {

void collect_texts(const toml::node& node, std::vector<std::string>& texts) {
  if (const auto* text = node.as_string()) texts.push_back(text->get());
  if (const auto* table = node.as_table())
    for (auto&& [key, value] : *table) collect_texts(value, texts);
  if (const auto* array = node.as_array())
    for (auto&& value : *array) collect_texts(value, texts);
}

}  // namespace

std::vector<std::string> TomlDocument::texts() const {
  std::vector<std::string> all;
  collect_texts(state_->root, all);
  return all;
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
    if (stray_character(written) != written.npos || stray_character(key) != key.npos) continue;
    try {
      return merge(*into, toml::parse(fmt::format("{}={}", key, written), name));
    } catch (const toml::parse_error&) {
    } catch (const TomlSurprise&) {
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

}  // namespace granrad
