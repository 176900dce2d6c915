#include "fit/vfgen/vfgen_options.h"

#include <fmt/core.h>

#include <charconv>

namespace granrad {

CLI::Validator number_in(double low, double high) {
  const auto problem = [low, high](std::string& text) -> std::string {
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = failure == std::errc{} && end == text.data() + text.size();
    if (whole && value >= low && value <= high) return {};
    return fmt::format("{} (must be a number in [{:g}, {:g}])", text, low, high);
  };
  return {problem, fmt::format("in [{:g}, {:g}]", low, high)};
}

CLI::Validator seed_number() {
  const auto problem = [](std::string& text) -> std::string {
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure == std::errc{} && end == text.data() + text.size() && value >= 0) return {};
    return fmt::format("{} (must be a whole number >= 0)", text);
  };
  return {problem, ">= 0"};
}

}  // namespace granrad
