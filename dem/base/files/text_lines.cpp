#include "dem/base/files/text_lines.h"

#include <algorithm>
#include <utility>

#include "dem/base/files/file_bytes.h"

namespace granrad {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) : TextLines(file_bytes(file)) {}

TextLines::TextLines(std::string text) : text_(std::make_shared<const std::string>(std::move(text))) {
  if (text_->starts_with("\xEF\xBB\xBF")) place_.at = 3;
}

bool TextLines::next(std::string_view& line) {
  if (at_end()) return false;
  const auto end = std::min(text_->find('\n', place_.at), text_->size());
  line = trimmed(std::string_view(*text_).substr(place_.at, end - place_.at));
  place_.at = end + 1;
  ++place_.number;
  return true;
}

TextLines TextLines::from(Place place) const {
  TextLines lines = *this;
  lines.place_ = place;
  return lines;
}

std::string_view TextLines::rest() const {
  return at_end() ? std::string_view() : std::string_view(*text_).substr(place_.at);
}

void TextLines::skip_bytes(std::size_t count) {
  place_.at += std::min(count, rest().size());
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
