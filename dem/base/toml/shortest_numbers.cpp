#include "dem/base/toml/shortest_numbers.h"

#include <fmt/core.h>

#include <charconv>

namespace granrad {

namespace {

bool in_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == 'e' || c == 'E' || c == '+' || c == '-';
}

std::string shortest(std::string_view word) {
  double value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc{} || end != word.data() + word.size()) return std::string(word);
  if (word.find_first_of(".eE") == word.npos) return std::string(word);
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == text.npos) text += ".0";
  return text;
}

}  // namespace

std::string with_shortest_numbers(std::string_view toml) {
  std::string out;
  char quote = 0, before = '\n';
  for (std::size_t at = 0; at < toml.size();) {
    const char c = toml[at];
    const bool starts = !quote && (in_number(c) && c != 'e' && c != 'E' && c != '.') &&
                        (before == ' ' || before == '[' || before == ',' || before == '=');
    if (starts) {
      std::size_t end = at;
      while (end < toml.size() && in_number(toml[end])) ++end;
      out += shortest(toml.substr(at, end - at));
      at = end;
      before = '0';
      continue;
    }
    if (!quote && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote && before != '\\')
      quote = 0;
    out += before = c;
    ++at;
  }
  return out;
}

}  // namespace granrad
