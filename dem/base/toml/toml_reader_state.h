#pragma once
// The inside of toml_reader.h, for its own .cpp files alone.
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

namespace granrad {
/// Thrown where toml++ finds text it took to be impossible.
struct TomlSurprise : std::logic_error {
  using std::logic_error::logic_error;
};
[[noreturn]] inline void surprise(const char* what) {
  throw TomlSurprise(what);
}
}  // namespace granrad

// Some malformed keys end in an assertion of toml++ 3.3 (and in undefined behaviour where assertions are off): here they
// are exceptions, in every kind of build.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) ((expr) ? static_cast<void>(0) : granrad::surprise(#expr))
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include "dem/base/problem_list.h"
#include "dem/base/toml/exploration.h"
#include "dem/base/toml/toml_reader.h"

namespace granrad {

std::string join_path(std::string_view table, std::string_view key);
/// The words in quotes, between commas.
std::string quoted_list(const std::vector<std::string>& words);
/// A scalar as it stands in the file; "" for arrays and tables.
std::string value_text(const toml::node& node);
Place place_of(const toml::source_region& source, const std::string& fallback_file);
/// Throws InputError at the place of a syntax error.
toml::table parse_toml(std::string_view text, const std::string& name);
/// Throws IoError.
toml::table parse_toml_file(const std::filesystem::path& file);

struct TomlDocument::State {
  std::string name;
  std::filesystem::path folder;
  toml::table root;
  ProblemList problems;
  std::map<std::string, std::set<std::string>> known, read;      ///< keys asked for, by table path
  std::map<std::string, std::vector<std::string>> absent_needs;  ///< keys required of tables that are absent
  std::map<std::string, std::filesystem::path> files;            ///< named and found, by path of the key
  std::map<std::string, std::filesystem::path> patterns;         ///< of names of files, by path of the key
  std::set<std::string> troubled;                                ///< paths that have a problem of their own
  std::vector<KeyUse> uses;                                      ///< every reading, in order
  std::set<std::string> asked_for;         ///< exploring: has() came first, so it is optional
  const Exploration* exploring = nullptr;  ///< no file: answers are made up

  void add(const Place& place, const std::string& path, std::string text);
  void add_at(const toml::node& node, const std::string& path, const std::string& why);
  toml::node* find(std::string_view path, toml::node* start);
  void report_unread(const toml::table& table, const std::string& path);
  void report_unknown(const toml::key& key, const toml::node& node, const std::string& table_path);
  void report_absent_tables();
};

struct TomlTable::Node {
  TomlDocument::State* state;
  toml::table* table;  ///< null when the table is absent
  std::string path;    ///< in messages
  std::string shown;   ///< in the reference

  /// Notes the reading of a key; the caller adds what it knows. Valid until the next reading.
  KeyUse& use(const Key& key, KeyKind kind, const NumberRule& rule = {}, bool required = false);
  toml::node* get(std::string_view key);
  std::string path_of(std::string_view key) const { return join_path(path, key); }
  bool exploring(Exploration::Depth at_least) const {
    return state->exploring && state->exploring->depth >= at_least;
  }

  /// What the exploration answers to a choice or a boolean.
  std::optional<std::string> picked(const Key& key) const;

  void missing(std::string_view key, const std::string& expected);
  double checked_number(const toml::node& node, const std::string& at, const NumberRule& rule);
  std::optional<Vec3> checked_vec3(const toml::node& node, const std::string& at, const NumberRule& rule);
  /// The array at `key`, with at least min_count entries; null (and a problem) otherwise.
  const toml::array* list(std::string_view key, std::size_t min_count, const std::string& of);
  /// What `read(entry, its path)` makes of the entries of the list at `key`, but those it makes nothing of.
  template <class Value, class Read>
  std::vector<Value> entries(std::string_view key, std::size_t min_count, const std::string& of, Read read) {
    std::vector<Value> all;
    const toml::array* array = list(key, min_count, of);
    for (std::size_t k = 0; array && k < array->size(); ++k)
      if (std::optional<Value> value = read((*array)[k], path_of(key) + "[" + std::to_string(k) + "]"))
        all.push_back(std::move(*value));
    return all;
  }
};

}  // namespace granrad
