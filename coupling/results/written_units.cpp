#include "coupling/results/written_units.h"

#include <fmt/core.h>

#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "dem/base/units.h"

namespace granrad {

namespace {

/// Where a scene says how it writes a quantity: table (as a prefix) and key, the first that has a unit counts.
std::vector<std::pair<std::string, std::string>> keys_of(const std::string& si_unit) {
  if (si_unit == "kg/s") return {{"feed", "mass_flow_kg_s"}, {"feed", "rate_kg_s"}};
  if (si_unit == "K")
    return {{"particles", "temperature_K"},
            {"walls", "temperature_K"},
            {"polygon", "temperature_K"},
            {"mesh", "temperature_K"}};
  if (si_unit == "m/s") return {{"feed", "velocity_m_s"}};
  if (si_unit == "s") return {{"scene", "end_time_s"}};
  return {};
}

/// The text of a key in a TOML document as it is written out: one key a line below the header of its table; "" where
/// it is no text.
std::string text_of(const std::string& document, const std::string& table, const std::string& key) {
  std::istringstream lines(document);
  const std::regex value(fmt::format(R"(\s*{}\s*=\s*['"]([^'"]*)['"])", key)), header(R"(\s*\[+([\w.]+).*)");
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch found; std::regex_match(line, found, header)) inside = found[1].str().starts_with(table);
    std::smatch found;
    if (inside && std::regex_match(line, found, value)) return found[1];
  }
  return "";
}

}  // namespace

PrintUnit written_unit(const Case& c, const std::string& si_unit) {
  for (const auto& [table, key] : keys_of(si_unit)) {
    const std::string text = text_of(c.effective_text, table, key);
    const auto begin = text.find_first_not_of("+-.0123456789eE ");
    if (begin == std::string::npos) continue;
    const std::string name = text.substr(begin);
    std::string why_not;
    const auto zero = quantity_in(fmt::format("0 {}", name), si_unit.c_str(), why_not),
               one = quantity_in(fmt::format("1 {}", name), si_unit.c_str(), why_not);
    if (zero && one) return {name, *one - *zero, *zero};
  }
  return {si_unit, 1, 0};
}

}  // namespace granrad
