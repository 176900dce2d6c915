#include "dem/base/files/markdown.h"

namespace granrad {

namespace {

std::string row_of(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const auto& cell : cells) {
    text += ' ';
    for (const char c : cell) {
      if (c == '|') text += '\\';
      text += c;
    }
    text += " |";
  }
  return text += '\n';
}

}  // namespace

std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows) {
  std::string text = row_of(header) + "|";
  for (std::size_t k = 0; k < header.size(); ++k) text += "---|";
  text += '\n';
  for (const auto& row : rows) text += row_of(row);
  return text;
}

}  // namespace granrad
