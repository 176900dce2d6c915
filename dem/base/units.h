#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace granrad {

/// Converts a quantity written with its unit, "0.8 mm", to a plain number in `unit` ("m"), by UDUNITS2;
/// offsets of temperature scales count ("20 degC" is 293.15 K). Empty when it cannot; `why_not` then says
/// why.
std::optional<double> quantity_in(std::string_view text, const char* unit, std::string& why_not);

}  // namespace granrad
