#pragma once
#include <functional>
#include <string>
#include <vector>

#include "dem/base/toml/key.h"
#include "dem/base/toml/toml_reader.h"

namespace granrad {

/// What is known of one key of a kind of file.
struct KnownKey {
  KeyUse use;  ///< the first reading that says most
  bool always_required = true, ever_required = false;
  bool default_varies = false;  ///< with other keys
  std::string when;             ///< `kind = "plug"`: read only with these choices; "" when always
};

/// One table: its own entry and its keys, in the order they are read.
struct KnownTable {
  std::string name;  ///< "radiation", "walls.FACE"; "" for the file itself
  std::string meaning;
  bool list = false;  ///< [[name]]
  std::vector<KnownKey> keys;
};

/// Every key a reader knows, found by running it on documents that are no files: without tables, with tables, with
/// keys, and once more for each answer to each choice and boolean. So a key is declared where it is read, and nowhere
/// else. `read` may throw InputError or report problems; both are ignored.
std::vector<KnownTable> key_catalogue(const std::function<void(TomlDocument&)>& read);

}  // namespace granrad
