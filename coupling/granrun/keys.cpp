#include "coupling/granrun/keys.h"

#include <fmt/core.h>

#include "coupling/simulation/heat_scene.h"
#include "dem/base/error.h"
#include "dem/base/toml/key_reference.h"
#include "fit/correlation/correlation.h"

namespace granrad {

namespace {

void read_scene_keys(TomlDocument& document) {
  const Scene flow = read_scene(document);
  read_heat_scene(document, flow);
}

void read_table_keys(TomlDocument& document) {
  read_correlation(document, "table");
}

}  // namespace

int print_keys(const std::string& of, const std::string& format) {
  const auto tables = key_catalogue(of == "table" ? read_table_keys : read_scene_keys);
  const std::string title = of == "table" ? "A correlation table of granrad" : "A scene of granrad";
  fmt::print("{}", format == "schema" ? reference_schema(tables, title)
                   : format == "toml" ? reference_toml(tables, title)
                                      : reference_markdown(tables));
  return exit_ok;
}

}  // namespace granrad
