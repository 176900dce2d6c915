#include "coupling/granrun/keys.h"

#include <fmt/core.h>

#include "coupling/simulation/heat_scene.h"
#include "dem/base/error.h"
#include "dem/base/toml/key_reference.h"
#include "fit/correlation/correlation.h"

namespace granrad {

void read_scene_keys(TomlDocument& document) {
  const Scene flow = read_scene(document);
  read_heat_scene(document, flow);
}

void read_table_keys(TomlDocument& document) {
  read_correlation(document, "table");
}

int print_keys(const KeyReader& read, const std::string& title, const std::string& format) {
  const auto tables = key_catalogue(read);
  fmt::print("{}", format == "schema" ? reference_schema(tables, title)
                   : format == "toml" ? reference_toml(tables, title)
                                      : reference_markdown(tables));
  return exit_ok;
}

}  // namespace granrad
