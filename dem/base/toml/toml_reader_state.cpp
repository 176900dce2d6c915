#include "dem/base/toml/toml_reader_state.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/toml/stray_character.h"
#include "dem/base/units.h"

namespace granrad {

std::string join_path(std::string_view table, std::string_view key) {
  return table.empty() || key.empty() ? fmt::format("{}{}", table, key) : fmt::format("{}.{}", table, key);
}

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

namespace {

std::string without_characters_beyond_ascii(std::string_view text) {
  std::string plain(text);
  for (char& c : plain)
    if (static_cast<unsigned char>(c) >= 0x80) c = 'x';
  return plain;
}

/// The first line up to which the text surprises toml++.
std::size_t line_of_surprise(std::string_view text) {
  std::size_t line = 1;
  for (auto end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1), ++line) {
    try {
      static_cast<void>(toml::parse(text.substr(0, end)));
    } catch (const TomlSurprise&) {
      break;
    } catch (const toml::parse_error&) {
    }
  }
  return line;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  if (const auto stray = stray_character(text); stray != text.npos) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(stray), '\n') + 1;
    const auto before = text.rfind('\n', stray);
    throw InputError(advised(fmt::format("{}:{}:{}: a character beyond ASCII stands outside of quotes", name,
                                         line, before == text.npos ? stray + 1 : stray - before),
                             "put the text in \"quotes\""));
  }
  try {
    // On text that is not TOML, toml++ 3.3 asks whether characters beyond ASCII are blanks in a way that is not defined
    // (found by a fuzzer): without them the text must be TOML already.
    static_cast<void>(toml::parse(without_characters_beyond_ascii(text), name));
    return toml::parse(text, name);
  } catch (const TomlSurprise&) {
    throw InputError(advised(fmt::format("{}:{}:1: is not TOML", name, line_of_surprise(text)),
                             "a key is one word, or text in quotes"));
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", name, error.source().begin.line, error.source().begin.column,
                                 error.description()));
  }
}

toml::table parse_toml_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  return parse_toml(std::string{std::istreambuf_iterator<char>(in), {}}, file.string());
}

void TomlDocument::State::add(const Place& place, const std::string& path, std::string text) {
  problems.add(place, std::move(text));
  troubled.insert(path);
}

void TomlDocument::State::add_at(const toml::node& node, const std::string& path, const std::string& why) {
  const std::string value = value_text(node);
  add(place_of(node.source(), name), path,
      why.starts_with("= ") ? fmt::format("{} {}", path, why)  // the caller shows the value
      : value.empty()       ? fmt::format("{}: {}", path, why)
                            : fmt::format("{} = {} ({})", path, value, why));
}

KeyUse& TomlTable::Node::use(const Key& key, KeyKind kind, const NumberRule& rule, bool required) {
  KeyUse use;
  use.table = shown;
  use.at = path;
  use.name = key.shown;
  use.meaning = key.meaning;
  use.otherwise = key.otherwise;
  use.kind = kind;
  use.rule = rule;
  use.required = required && !state->asked_for.count(path_of(key.name));
  use.given = table && table->contains(key.name);
  state->uses.push_back(std::move(use));
  return state->uses.back();
}

std::optional<std::string> TomlTable::Node::picked(const Key& key) const {
  if (!state->exploring) return std::nullopt;
  const auto found = state->exploring->picks.find(join_path(shown, key.shown));
  if (found == state->exploring->picks.end()) return std::nullopt;
  return found->second;
}

toml::node* TomlTable::Node::get(std::string_view key) {
  state->known[path].emplace(key);
  state->read[path].emplace(key);
  return table ? table->get(key) : nullptr;
}

void TomlTable::Node::missing(std::string_view key, const std::string& expected) {
  if (!table) {
    state->absent_needs[path].emplace_back(key);
    return;
  }
  state->add(path.empty() ? Place{state->name} : place_of(table->source(), state->name), path_of(key),
             fmt::format("{} is missing: {}", path_of(key), expected));
}

double TomlTable::Node::checked_number(const toml::node& node, const std::string& at,
                                       const NumberRule& rule) {
  double value = 0;
  std::string why_not, shown = value_text(node);
  if (const auto* text = node.as_string()) {
    const auto converted = quantity_in(text->get(), rule.unit, why_not);
    if (converted && std::string_view(rule.unit) != "1")
      shown += fmt::format(" = {:.10g} {}", *converted, rule.unit);
    value = converted.value_or(0);
  } else if (node.is_number()) {
    // value<double>() gives nothing for an integer that no double holds exactly
    const auto* whole = node.as_integer();
    value = whole ? static_cast<double>(whole->get()) : node.as_floating_point()->get();
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

std::optional<Vec3> TomlTable::Node::checked_vec3(const toml::node& node, const std::string& at,
                                                  const NumberRule& rule) {
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

const toml::array* TomlTable::Node::list(std::string_view key, std::size_t min_count, const std::string& of) {
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

}  // namespace granrad
