#include "dem/base/number_rule.h"

#include <fmt/core.h>

#include <cmath>
#include <string_view>

namespace granrad {

bool inside(const NumberRule& rule, double value) {
  return (rule.min_exclusive ? value > rule.min : value >= rule.min) &&
         (rule.max_exclusive ? value < rule.max : value <= rule.max);
}

std::string bounds_text(const NumberRule& rule) {
  const bool low = std::isfinite(rule.min), high = std::isfinite(rule.max);
  const std::string unit = std::string_view(rule.unit) == "1" ? "" : fmt::format(" {}", rule.unit);
  if (low && high)
    return fmt::format("in {}{}, {}{}{}", rule.min_exclusive ? '(' : '[', rule.min, rule.max,
                       rule.max_exclusive ? ')' : ']', unit);
  if (low) return fmt::format("{} {}{}", rule.min_exclusive ? ">" : ">=", rule.min, unit);
  if (high) return fmt::format("{} {}{}", rule.max_exclusive ? "<" : "<=", rule.max, unit);
  return "";
}

double placeholder(const NumberRule& rule) {
  const bool low = std::isfinite(rule.min), high = std::isfinite(rule.max);
  if (low && high) return 0.5 * (rule.min + rule.max);
  return low ? rule.min + 1 : high ? rule.max - 1 : 1;
}

std::string expected_number(const NumberRule& rule) {
  const std::string bounds = bounds_text(rule);
  if (!bounds.empty()) return fmt::format("a number {}", bounds);
  return std::string_view(rule.unit) == "1" ? "a number" : fmt::format("a number in {}", rule.unit);
}

}  // namespace granrad
