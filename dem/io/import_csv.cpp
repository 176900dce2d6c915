#include "dem/io/import_csv.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/io/particle_table.h"

namespace granrad {

namespace {

/// R and ParaView put names in quotes.
std::string unquoted(std::string_view name) {
  const bool quoted = name.size() >= 2 && name.front() == '"' && name.back() == '"';
  return std::string(quoted ? name.substr(1, name.size() - 2) : name);
}

}  // namespace

Snapshot import_csv(const std::string& file, TextLines lines, double radius_m) {
  std::string_view line;
  const auto next_row = [&] {
    while (lines.next(line))
      if (!line.empty() && line.front() != '#') return true;
    return false;
  };
  if (!next_row()) throw InputError(fmt::format("{}: is empty; its first line must be x,y,z,radius", file));
  std::vector<std::string_view> fields;
  split_at(',', line, fields);
  if (const auto other = line.find_first_of("; \t"); fields.size() == 1 && other != line.npos)
    throw InputError(
        advised(fmt::format("{}:{}: \"{}\" (columns are separated by commas: x,y,z,radius)", file,
                            lines.line_number(), line),
                fmt::format("replace '{}'", line[other] == '\t' ? "\\t" : std::string(1, line[other]))));
  std::vector<std::string> names;
  for (const auto field : fields) names.push_back(unquoted(field));
  ParticleTable table(file, lines.line_number(), std::move(names), radius_m);
  while (next_row()) {
    split_at(',', line, fields);
    table.add_row(lines.line_number(), fields);
  }
  return table.finish();
}

}  // namespace granrad
