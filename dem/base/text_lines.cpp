#include "dem/base/text_lines.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  in.seekg(0, std::ios::end);
  text_.resize(static_cast<std::size_t>(std::max<std::streamoff>(in.tellg(), 0)));
  in.seekg(0);
  if (!in.read(text_.data(), static_cast<std::streamsize>(text_.size())))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
}

bool TextLines::next(std::string_view& line) {
  if (at_ >= text_.size()) return false;
  const auto end = std::min(text_.find('\n', at_), text_.size());
  line = trimmed(std::string_view(text_).substr(at_, end - at_));
  at_ = end + 1;
  ++number_;
  return true;
}

void split_at(char separator, std::string_view line, std::vector<std::string_view>& out) {
  out.clear();
  for (std::size_t begin = 0;;) {
    const auto end = line.find(separator, begin);
    out.push_back(trimmed(line.substr(begin, end == line.npos ? end : end - begin)));
    if (end == line.npos) return;
    begin = end + 1;
  }
}

void split_words(std::string_view line, std::vector<std::string_view>& out) {
  out.clear();
  for (auto begin = line.find_first_not_of(blanks); begin != line.npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    out.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
}

}  // namespace granrad
