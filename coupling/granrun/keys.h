#pragma once
#include <string>

namespace granrad {

/// granrun keys: every key of a kind of file ("scene", "study" or "table") on stdout, as "md" (a page), "toml" (a
/// commented file to start from) or "schema" (JSON schema for editors). Collected from the readers (key_catalogue.h).
int print_keys(const std::string& of, const std::string& format);

}  // namespace granrad
