#include "fit/vfgen/vfgen_options.h"

#include <fmt/core.h>

#include <charconv>
#include <map>

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

CLI::Validator memory_size() {
  const auto problem = [](std::string& text) -> std::string {
    const std::map<std::string, double> units{
        {"", 1},        {"b", 1},         {"k", 1024},     {"kib", 1024},  {"kb", 1e3},
        {"m", 1 << 20}, {"mib", 1 << 20}, {"mb", 1e6},     {"g", 1 << 30}, {"gib", 1 << 30},
        {"gb", 1e9},    {"t", 0x1p40},    {"tib", 0x1p40}, {"tb", 1e12}};
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string unit = CLI::detail::to_lower(
        CLI::detail::trim_copy(text.substr(static_cast<std::size_t>(end - text.data()))));
    const auto known = units.find(unit);
    const double bytes = known == units.end() ? 0 : value * known->second;
    if (failure != std::errc{} || !(bytes >= 1 && bytes <= 0x1p50))
      return fmt::format("{} (must be a size of 1 byte to 1024 TiB, such as 512MiB)", text);
    text = fmt::format("{:.0f}", bytes);
    return {};
  };
  return {problem, "SIZE"};
}

}  // namespace granrad
