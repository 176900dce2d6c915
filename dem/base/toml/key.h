#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/base/number_rule.h"

namespace granrad {

/// A key where it is read: {"friction", "Coulomb coefficient of sliding"}. Name, meaning, unit, range and default stand
/// together at the one place that uses the value; the catalogue of keys (key_catalogue.h) is collected from there.
struct Key {
  std::string_view name;
  std::string_view meaning;  ///< for the reference, a phrase without a full stop
  std::string_view
      otherwise;  ///< the default in words, where it follows from other keys ("end_time_s / 100")
  std::string_view
      shown;  ///< stands for the name in the reference where users choose the name ("FACE", "NAME")

  Key(const char* name, std::string_view meaning = {}, std::string_view otherwise = {},
      std::string_view shown = {})
      : Key(std::string_view(name), meaning, otherwise, shown) {}
  Key(const std::string& name, std::string_view meaning = {}, std::string_view otherwise = {},
      std::string_view shown = {})
      : Key(std::string_view(name), meaning, otherwise, shown) {}
  Key(std::string_view name, std::string_view meaning = {}, std::string_view otherwise = {},
      std::string_view shown = {})
      : name(name), meaning(meaning), otherwise(otherwise), shown(shown.empty() ? name : shown) {}
};

enum class KeyKind {
  number,
  integer,
  boolean,
  text,
  choice,
  file,
  vector,
  vectors,
  numbers,
  texts,
  text_lists,  ///< lists of texts
  values,      ///< numbers, texts and booleans
  table,
  tables,
};

/// One reading of a key.
struct KeyUse {
  std::string
      table;  ///< as the reference shows it: "radiation", "walls.FACE", "polygon"; "" for the file itself
  std::string name, meaning, otherwise;
  KeyKind kind = KeyKind::text;
  NumberRule rule;  ///< of numbers, integers, and of each entry of lists
  std::vector<std::string> choices;
  std::optional<std::string> fallback;  ///< the default as TOML
  bool required = false;

  std::string at;      ///< the table as messages name it: "walls.y_min", "polygon[2]"
  bool given = false;  ///< the file has it
  std::string value;   ///< of choices and booleans, what was returned
};

}  // namespace granrad
