#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// A text file in memory, read line by line; line ends LF or CRLF, a byte order mark is skipped.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& file);  ///< throws IoError
  /// The next line without its end; false at the end of the file.
  bool next(std::string_view& line);
  std::size_t line_number() const { return number_; }  ///< of the line `next` gave last, from 1

 private:
  std::string text_;
  std::size_t at_ = 0, number_ = 0;
};

/// Pieces between separators, without surrounding blanks; `out` is overwritten.
void split_at(char separator, std::string_view line, std::vector<std::string_view>& out);
/// Words between blanks.
void split_words(std::string_view line, std::vector<std::string_view>& out);

}  // namespace granrad
