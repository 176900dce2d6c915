#include "dem/base/toml/stray_character.h"

#include <algorithm>

namespace granrad {

namespace {

/// The place after the text in quotes that begins at `from`; the end of the line, or of all, where it is not closed.
std::size_t after_quotes(std::string_view toml, std::size_t from) {
  const char quote = toml[from];
  const bool long_text = toml.substr(from, 3) == std::string_view(quote == '"' ? R"(""")" : "'''");
  const std::size_t width = long_text ? 3 : 1;
  for (std::size_t k = from + width; k < toml.size(); ++k) {
    if (quote == '"' && toml[k] == '\\')
      ++k;
    else if (toml[k] == '\n' && !long_text)
      return k;
    else if (toml.substr(k, width) == toml.substr(from, width))
      return k + width;
  }
  return toml.size();
}

}  // namespace

std::size_t stray_character(std::string_view toml) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  for (std::size_t k = toml.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; k < toml.size();) {
    if (static_cast<unsigned char>(toml[k]) >= 0x80) return k;
    if (toml[k] == '#')
      k = std::min(toml.find('\n', k), toml.size());
    else if (toml[k] == '"' || toml[k] == '\'')
      k = after_quotes(toml, k);
    else
      ++k;
  }
  return std::string_view::npos;
}

}  // namespace granrad
