#include "dem/base/units.h"

#include <fmt/core.h>
#include <udunits2.h>

#include <cstdlib>
#include <memory>
#include <regex>

#include "dem/base/error.h"

namespace granrad {

namespace {

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using System = std::unique_ptr<ut_system, FreeSystem>;
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

/// The unit database, read on first use (a few milliseconds).
ut_system* units() {
  static const System system = [] {
    ut_set_error_message_handler(ut_ignore);
    return System(ut_read_xml(nullptr));
  }();
  if (!system)
    throw IoError("the UDUNITS2 unit database cannot be read; install it or set UDUNITS2_XML_PATH");
  return system.get();
}

/// What engineers and these programs write, read as it is meant: all that follows the stroke is below it.
/// "W/mK" -> "W/(m K)", "W/m²K" -> "W/(m² K)", "J/(kgK)" -> "J/(kg K)".
std::string spelt_out(const std::string& name) {
  static const std::regex below(R"(/ *\(?(kg|g|[mc]?m(?:[23]|²|³|\^[23])?)[ .*·]?K\)?$)");
  return std::regex_replace(name, below, "/($1 K)");
}

Converter converter_to(const Unit& to, const std::string& name) {
  const Unit from(ut_parse(units(), name.c_str(), UT_UTF8));
  return Converter(from && to ? ut_get_converter(from.get(), to.get()) : nullptr);
}

std::string why_no_unit(const std::string& name, const char* unit) {
  if ((name == "C" || name == "c" || name == "F") && std::string_view(unit) == "K")
    return fmt::format("'{0}' is no temperature; degrees are written deg{0}", name == "F" ? "F" : "C");
  const Unit from(ut_parse(units(), name.c_str(), UT_UTF8));
  return from ? fmt::format("'{}' cannot be converted to {}", name, unit)
              : fmt::format("'{}' is not a unit; expected one of the kind of {}", name, unit);
}

}  // namespace

std::optional<double> quantity_in(std::string_view text, const char* unit, std::string& why_not) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  std::string name(end);
  ut_trim(name.data(), UT_UTF8);
  name.resize(name.find_last_not_of(std::string("\0 \t", 3)) + 1);
  if (end == copy.c_str()) {
    why_not = std::string_view(unit) == "1"
                  ? "must be a number"
                  : fmt::format("must be a number in {0}, or text with a unit, \"1 {0}\"", unit);
  } else if (name.empty()) {
    why_not = fmt::format("has no unit: write the number without quotes for {}, or add the unit", unit);
  } else {
    const Unit to(ut_parse(units(), unit, UT_UTF8));
    Converter converter = converter_to(to, name);
    if (!converter) converter = converter_to(to, spelt_out(name));
    if (converter) return cv_convert_double(converter.get(), value);
    why_not = why_no_unit(name, unit);
  }
  return std::nullopt;
}

}  // namespace granrad
