#include "dem/scene/import_csv.h"

#include <fmt/core.h>

#include "dem/scene/error.h"
#include "dem/scene/particle_table.h"
#include "dem/scene/text_lines.h"

namespace granrad {

Snapshot import_csv(const std::filesystem::path& file, double radius_m) {
  TextLines lines(file);
  std::string_view line;
  const auto next_row = [&] {
    while (lines.next(line))
      if (!line.empty() && line.front() != '#') return true;
    return false;
  };
  if (!next_row())
    throw InputError(fmt::format("{}: is empty; its first line must be x,y,z,radius", file.string()));
  std::vector<std::string_view> fields;
  split_at(',', line, fields);
  ParticleTable table(file.string(), lines.line_number(), {fields.begin(), fields.end()}, radius_m);
  while (next_row()) {
    split_at(',', line, fields);
    table.add_row(lines.line_number(), fields);
  }
  return table.finish();
}

}  // namespace granrad
