#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/base/number_rule.h"
#include "dem/base/toml/choice_names.h"
#include "dem/base/toml/key.h"
#include "dem/base/vec3.h"

namespace granrad {

class TomlTable;
struct Exploration;

/// One TOML file with every problem collected: syntax, wrong types, units, bounds, unknown keys. The only
/// user of toml++. Each room reads the tables it understands; after all have read, `finish()` reports every
/// key nobody asked for (with the closest known key as a suggestion) and throws InputError with all
/// problems at once, sorted by position. Reading never throws: a bad value is recorded and a placeholder
/// inside the rule's bounds is returned, so that later problems are found too.
class TomlDocument {
 public:
  /// Throws IoError when the file cannot be read, InputError (with line and column) on a syntax error.
  static TomlDocument from_file(const std::filesystem::path& file);
  static TomlDocument from_string(std::string_view text, const std::string& name_in_messages);
  /// No file: answers its readers as told, for key_catalogue.h. `how` must outlive it.
  static TomlDocument exploring(const Exploration& how);
  TomlDocument(TomlDocument&&) noexcept;
  TomlDocument& operator=(TomlDocument&&) noexcept;
  ~TomlDocument();

  /// `--set radiation.rays=1000`: parsed as TOML value (bare words as strings); located as `--set`.
  void override_value(std::string_view key_equals_value);

  /// Takes a key out, as if it had not been written ("feed.mass_flow_kg_s"); a problem when it is not there.
  void remove_key(std::string_view path);
  /// Every text value of the document in force, in order: file names among them.
  std::vector<std::string> texts() const;

  TomlTable root();
  /// Folder of the file: relative paths inside it start here.
  std::filesystem::path folder() const;
  /// Records a problem at the place of `path` ("material.friction"; "" for the file) in the house format.
  void problem(std::string_view path, std::string_view message);
  /// Throws InputError if anything was recorded or any key stayed unread.
  void finish();
  /// The document as it is in force (with overrides), as TOML text.
  std::string effective_text() const { return effective_text({}); }
  /// The same with other texts at some keys: by path ("mesh[0].file").
  std::string effective_text(const std::map<std::string, std::string>& texts) const;
  /// Every file named so far, by the path of its key, as it was found on disk.
  const std::map<std::string, std::filesystem::path>& files() const;
  /// Patterns of names of files, by path of the key, as TomlTable::pattern gave them.
  const std::map<std::string, std::filesystem::path>& patterns() const;
  /// The same, with every default that was used as a comment: `# restitution = 0.8`.
  std::string text_with_defaults() const;
  /// Every reading of a key so far, in order.
  const std::vector<KeyUse>& uses() const;

 private:
  friend class TomlTable;
  struct State;
  TomlDocument();
  std::unique_ptr<State> state_;
};

/// A table of the document. A key that is read is a known key. Absent tables read as empty. Keys are given with their
/// meaning: table.number({"friction", "Coulomb coefficient of sliding"}, {.min = 0}).
class TomlTable {
 public:
  bool present() const;
  std::string path() const;   ///< "radiation", "walls.y_min", "polygon[2]"; "" for the root
  std::int64_t line() const;  ///< where it starts in its file; 0 when absent or given by --set
  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;

  double number(const Key& key, const NumberRule& rule);                   ///< required
  double number(const Key& key, const NumberRule& rule, double fallback);  ///< optional
  std::optional<double> optional_number(const Key& key, const NumberRule& rule);
  /// A number, or "auto": then empty. `automatic`: whether that is the default, else `fallback`.
  std::optional<double> number_or_auto(const Key& key, const NumberRule& rule, double fallback,
                                       bool automatic = false);
  std::int64_t integer(const Key& key, std::int64_t min, std::int64_t max,
                       std::optional<std::int64_t> fallback = {});
  bool boolean(const Key& key, std::optional<bool> fallback = {});
  std::string string(const Key& key, std::optional<std::string> fallback = {});
  /// One of `allowed`; anything else is a problem that lists them and suggests the closest.
  std::string choice(const Key& key, const std::vector<std::string>& allowed,
                     std::optional<std::string> fallback = {});
  template <auto last>
  decltype(last) choice(const Key& key, const ChoiceNames<last>& names,
                        std::optional<decltype(last)> fallback = {}) {
    const auto word = fallback ? std::optional<std::string>(names.of(*fallback)) : std::nullopt;
    return *names.value(choice(key, names.all(), word));
  }
  /// An existing file: beside the document, else among the installed data (data_folder.h); made absolute.
  std::filesystem::path file(const Key& key, bool required);
  /// Names of files, with * and ?, made absolute from the folder of the document; empty when absent.
  std::filesystem::path pattern(const Key& key);
  Vec3 vec3(const Key& key, const NumberRule& each, std::optional<Vec3> fallback = {});
  std::vector<Vec3> vec3_list(const Key& key, const NumberRule& each, std::size_t min_count);
  std::vector<double> number_list(const Key& key, const NumberRule& each, std::size_t min_count);
  std::vector<std::string> string_list(const Key& key, std::size_t min_count = 0);
  std::vector<std::vector<std::string>> string_lists(const Key& key, std::size_t min_count = 0);
  /// Numbers, texts and booleans, each as `override_value` reads them.
  std::vector<std::string> value_list(const Key& key, std::size_t min_count = 0);

  /// When `key` names a TOML file, the keys of that file's root that this table lacks are added to it; they
  /// keep their place in that file for messages.
  void add_keys_from_file(const Key& key);

  TomlTable table(const Key& key);                ///< [key]; absent reads as empty
  std::vector<TomlTable> tables(const Key& key);  ///< [[key]]
  /// Records a problem at `key` of this table, or at the table when the key is absent, as `path = value
  /// (message)`; a message that starts with "= " shows the value itself.
  void problem(std::string_view key, std::string_view message);

 private:
  friend class TomlDocument;
  struct Node;
  explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

}  // namespace granrad
