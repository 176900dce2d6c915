#include "dem/base/stated_number.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {

/// The power of ten of the first digit, as it is printed with two digits: 0.0999 is 0.10.
int first_place(double error) {
  const int place = static_cast<int>(std::floor(std::log10(error)));
  return error >= 9.95 * std::pow(10.0, place) ? place + 1 : place;
}

}  // namespace

StatedNumber stated(double value, double error) {
  if (!std::isfinite(value)) return {};
  constexpr double rounding = 1e-12;  // of a constant that was averaged
  if (!std::isfinite(error) || error <= rounding * std::abs(value)) return {fmt::format("{:.4g}", value), ""};
  const int place = first_place(error), decimals = 1 - place;
  constexpr int most_decimals = 6;
  if (decimals > most_decimals && std::max(std::abs(value), error) < 1e-3) {
    const double larger = std::max(std::abs(value), error);
    const int digits = std::max(1, static_cast<int>(std::floor(std::log10(larger))) - place + 1);
    return {fmt::format("{:.{}e}", value, digits), fmt::format("{:.1e}", error)};
  }
  if (decimals >= 0)
    return {fmt::format("{:.{}f}", value, decimals), fmt::format("{:.{}f}", error, decimals)};
  const double unit = std::pow(10.0, -decimals);
  return {fmt::format("{:.0f}", unit * std::round(value / unit)),
          fmt::format("{:.0f}", unit * std::round(error / unit))};
}

}  // namespace granrad
