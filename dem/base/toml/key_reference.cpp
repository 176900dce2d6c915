#include "dem/base/toml/key_reference.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dem/base/files/markdown.h"

namespace granrad {

namespace {

using Json = nlohmann::ordered_json;

std::string unit_of(const KeyUse& use) {
  const std::string unit = use.rule.unit;
  const bool has_unit = use.kind == KeyKind::number || use.kind == KeyKind::vector ||
                        use.kind == KeyKind::vectors || use.kind == KeyKind::numbers;
  return has_unit && unit != "1" ? unit : "";
}

std::string header_of(const KnownTable& table) {
  return table.list ? fmt::format("[[{}]]", table.name) : fmt::format("[{}]", table.name);
}

/// "  # " and the text, broken into lines of about 90 columns.
std::string comment(const std::string& text, const std::string& indent) {
  std::istringstream words(text);
  std::string out, line = indent;
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > 90 && line != indent) {
      out += line;
      out += "\n";
      line = indent;
    }
    line += " ";
    line += word;
  }
  return fmt::format("{}{}\n", out, line);
}

Json number_schema(const NumberRule& rule, const char* type) {
  Json number{{"type", type}};
  if (std::isfinite(rule.min)) number[rule.min_exclusive ? "exclusiveMinimum" : "minimum"] = rule.min;
  if (std::isfinite(rule.max)) number[rule.max_exclusive ? "exclusiveMaximum" : "maximum"] = rule.max;
  if (std::string(type) == "integer") return number;
  return Json{{"anyOf", {number, {{"type", "string"}}}}};  // "0.8 mm"
}

Json value_schema(const KeyUse& use) {
  switch (use.kind) {
    case KeyKind::number:
      return number_schema(use.rule, "number");
    case KeyKind::integer:
      return number_schema(use.rule, "integer");
    case KeyKind::boolean:
      return {{"type", "boolean"}};
    case KeyKind::text:
    case KeyKind::file:
      return {{"type", "string"}};
    case KeyKind::choice:
      return {{"enum", use.choices}};
    case KeyKind::vector:
      return {
          {"type", "array"}, {"items", number_schema(use.rule, "number")}, {"minItems", 3}, {"maxItems", 3}};
    case KeyKind::vectors:
      return {{"type", "array"},
              {"items",
               {{"type", "array"},
                {"items", number_schema(use.rule, "number")},
                {"minItems", 3},
                {"maxItems", 3}}}};
    case KeyKind::numbers:
      return {{"type", "array"}, {"items", number_schema(use.rule, "number")}};
    case KeyKind::texts:
      return {{"type", "array"}, {"items", {{"type", "string"}}}};
    case KeyKind::text_lists:
      return {{"type", "array"}, {"items", {{"type", "array"}, {"items", {{"type", "string"}}}}}};
    case KeyKind::values:
      return {{"type", "array"}, {"items", {{"type", {"number", "string", "boolean"}}}}};
    case KeyKind::table:
    case KeyKind::tables:
      break;
  }
  return Json::object();
}

Json key_schema(const KnownKey& key) {
  Json schema = value_schema(key.use);
  std::string text = key.use.meaning;
  if (const auto unit = unit_of(key.use); !unit.empty()) text += fmt::format(" [{}]", unit);
  if (!key.when.empty()) text += fmt::format(" (with {})", key.when);
  if (const auto fallback = default_text(key); !fallback.empty())
    text += fmt::format("; default: {}", fallback);
  schema["description"] = text;
  return schema;
}

Json empty_object() {
  return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
}

bool names_are_free(const std::string& name) {
  return !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == std::string::npos;
}

/// The schema of a table, made with those above it where it is missing.
Json& object_at(Json& root, const std::vector<KnownTable>& tables, const std::string& path) {
  Json* here = &root;
  for (std::size_t from = 0; from < path.size();) {
    const auto dot = std::min(path.find('.', from), path.size());
    const std::string name = path.substr(from, dot - from), so_far = path.substr(0, dot);
    bool list = false;
    for (const auto& table : tables) list = list || (table.name == so_far && table.list);
    Json& slot = names_are_free(name) ? (*here)["additionalProperties"] : (*here)["properties"][name];
    if (!slot.is_object()) slot = list ? Json{{"type", "array"}, {"items", empty_object()}} : empty_object();
    here = list ? &slot["items"] : &slot;
    from = dot + 1;
  }
  return *here;
}

}  // namespace

std::string values_text(const KeyUse& use) {
  const std::string bounds = bounds_text({.unit = "1",
                                          .min = use.rule.min,
                                          .max = use.rule.max,
                                          .min_exclusive = use.rule.min_exclusive,
                                          .max_exclusive = use.rule.max_exclusive});
  const auto bounded = [&](const std::string& what) {
    return bounds.empty() ? what : fmt::format("{} {}", what, bounds);
  };
  switch (use.kind) {
    case KeyKind::number:
      return bounded("number");
    case KeyKind::integer:
      return bounded("integer");
    case KeyKind::boolean:
      return "true, false";
    case KeyKind::text:
      return "text";
    case KeyKind::choice:
      return fmt::format("\"{}\"", fmt::join(use.choices, "\", \""));
    case KeyKind::file:
      return "file";
    case KeyKind::vector:
      return bounded("[x, y, z]");
    case KeyKind::vectors:
      return "list of [x, y, z]";
    case KeyKind::numbers:
      return fmt::format("list, each {}", bounded("number"));
    case KeyKind::texts:
      return "list of texts";
    case KeyKind::text_lists:
      return "list of lists of texts";
    case KeyKind::values:
      return "list of numbers, texts or booleans";
    case KeyKind::table:
    case KeyKind::tables:
      break;
  }
  return "";
}

std::string default_text(const KnownKey& key) {
  if (!key.use.otherwise.empty()) return key.use.otherwise;
  if (key.always_required) return "required";
  if (key.use.fallback && !key.default_varies) return *key.use.fallback;
  return key.ever_required ? "required in some scenes" : "";
}

std::string reference_markdown(const std::vector<KnownTable>& tables) {
  std::string text;
  for (const auto& table : tables) {
    if (!table.name.empty()) text += fmt::format("## `{}`\n\n", header_of(table));
    if (!table.meaning.empty()) text += fmt::format("{}.\n\n", table.meaning);
    if (table.keys.empty()) continue;
    std::vector<std::vector<std::string>> rows;
    for (const auto& key : table.keys) {
      std::string meaning = key.use.meaning;
      if (!key.when.empty()) meaning += fmt::format("{}*with* `{}`", meaning.empty() ? "" : "; ", key.when);
      const std::string fallback = default_text(key);
      const bool code = key.use.otherwise.empty() && key.use.fallback && fallback == *key.use.fallback;
      rows.push_back({fmt::format("`{}`", key.use.name), values_text(key.use), unit_of(key.use),
                      code ? fmt::format("`{}`", fallback) : fallback, meaning});
    }
    text += markdown_table({"key", "values", "unit", "default", "meaning"}, rows) + "\n";
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

std::string reference_toml(const std::vector<KnownTable>& tables, const std::string& title) {
  std::string text = fmt::format("# {}\n", title);
  for (const auto& table : tables) {
    if (table.keys.empty()) continue;
    text += "\n";
    if (!table.meaning.empty()) text += comment(table.meaning, "#");
    if (!table.name.empty()) text += fmt::format("# {}\n", header_of(table));
    for (const auto& key : table.keys) {
      const std::string unit = unit_of(key.use), fallback = default_text(key);
      std::string about =
          fmt::format("{}: {}{}", key.use.meaning, values_text(key.use), unit.empty() ? "" : ", " + unit);
      if (!key.when.empty()) about += fmt::format("; with {}", key.when);
      text += comment(about, "#  ");
      text += key.use.fallback && fallback == *key.use.fallback
                  ? fmt::format("# {} = {}\n", key.use.name, fallback)
                  : fmt::format("# {} =   # {}\n", key.use.name, fallback.empty() ? "optional" : fallback);
    }
  }
  return text;
}

std::string reference_schema(const std::vector<KnownTable>& tables, const std::string& title) {
  Json root = empty_object();
  Json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  for (const auto& table : tables) {
    Json& object = object_at(root, tables, table.name);
    if (!table.meaning.empty()) object["description"] = table.meaning;
    for (const auto& key : table.keys) {
      if (names_are_free(key.use.name))
        object["additionalProperties"] = key_schema(key);
      else
        object["properties"][key.use.name] = key_schema(key);
    }
  }
  out.update(root);
  return out.dump(2) + "\n";
}

}  // namespace granrad
