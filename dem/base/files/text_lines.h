#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// A text in memory, read line by line; line ends LF or CRLF, a byte order mark is skipped. Copies share the
/// text, and read on where the copied one stands.
class TextLines {
 public:
  /// A place between lines.
  struct Place {
    std::size_t at = 0, number = 0;
  };

  explicit TextLines(const std::filesystem::path& file);  ///< throws IoError; unpacks gzip
  explicit TextLines(std::string text);
  /// The next line without its end and without blanks around it; false at the end.
  bool next(std::string_view& line);
  std::size_t line_number() const { return place_.number; }  ///< of the line `next` gave last, from 1

  Place place() const { return place_; }
  TextLines from(Place place) const;
  bool at_end() const { return place_.at >= text_->size(); }
  bool ends_with_newline() const { return text_->ends_with('\n'); }
  /// What follows the line `next` gave last: binary data between lines.
  std::string_view rest() const;
  void skip_bytes(std::size_t count);

 private:
  std::shared_ptr<const std::string> text_;
  Place place_;
};

/// Pieces between separators, without surrounding blanks; `out` is overwritten.
void split_at(char separator, std::string_view line, std::vector<std::string_view>& out);
/// Words between blanks.
void split_words(std::string_view line, std::vector<std::string_view>& out);

}  // namespace granrad
