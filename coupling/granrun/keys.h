#pragma once
#include <functional>
#include <string>

namespace granrad {

class TomlDocument;

using KeyReader = std::function<void(TomlDocument&)>;

/// Readers of the keys of scenes and of correlation tables.
void read_scene_keys(TomlDocument& document);
void read_table_keys(TomlDocument& document);

/// granrun keys: every key `read` knows on stdout, as "md" (a page), "toml" (a commented file to start from) or "schema"
/// (JSON schema for editors). Collected from the readers (key_catalogue.h).
int print_keys(const KeyReader& read, const std::string& title, const std::string& format);

}  // namespace granrad
