#pragma once
#include <string>
#include <vector>

#include "dem/base/toml/key_catalogue.h"

namespace granrad {

/// A reference in Markdown: one section a table, one row a key (name, values, unit, default, meaning).
std::string reference_markdown(const std::vector<KnownTable>& tables);
/// A commented file to start from: every table and key, keys with their default or what they need.
std::string reference_toml(const std::vector<KnownTable>& tables, const std::string& title);
/// A JSON schema (draft 2020-12) for editors: completion, hover texts, wrong keys marked.
std::string reference_schema(const std::vector<KnownTable>& tables, const std::string& title);

/// "number > 0", "\"plug\" or \"hopper\"", "[x, y, z]".
std::string values_text(const KeyUse& use);
/// "0.2", "required", "end_time_s / 100"; "" when there is none.
std::string default_text(const KnownKey& key);

}  // namespace granrad
