#pragma once
#include <string>

namespace granrad {

/// A number as people read it: two significant digits of its standard error, and the value to the same place.
struct StatedNumber {
  std::string value,
      error;  ///< error "" where none is known (not finite, not above 0, or mere rounding: below 1e-12 of the value)

  /// "107.9 ± 0.52", or the value alone; `between` stands between the two.
  std::string text(const std::string& between = " ± ") const {
    return error.empty() ? value : value + between + error;
  }
};

/// (107.934, 0.5178) -> "107.93" and "0.52"; (1234, 56) -> "1234", "56"; (1234, 561) -> "1230", "560"; small ones with an
/// exponent. Without an error four significant digits. A value that is not finite is "".
StatedNumber stated(double value, double error);

}  // namespace granrad
