#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// A number as a cell: empty where there is no value, which pandas and spreadsheets read as missing.
std::string cell(double value, int digits = 12);
/// A text as a cell: in quotes where it must be (RFC 4180).
std::string text_cell(const std::string& text);
/// The cells of a line; a quoted cell may hold commas and doubled quotes, which are taken off.
std::vector<std::string> split_cells(const std::string& line);
/// The number in a cell; NaN where it is empty or no number.
double cell_number(const std::string& cell);

/// A table of comma-separated cells below a line of names.
struct CsvTable {
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  std::string file;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as names; others are left out
  std::vector<int> line;                       ///< of each row in the file, from 1

  std::size_t find(const std::string& name) const;             ///< place of a column, or nowhere
  std::size_t column(const std::string& name) const;           ///< throws InputError, naming the file
  std::vector<double> numbers(const std::string& name) const;  ///< cell_number of each row; throws InputError
};

/// Reads a table; empty lines and lines that begin with # are passed by. Rows of another number of cells (one being
/// written now) are left out, or refused where `whole`. Throws IoError, InputError.
CsvTable read_csv(const std::filesystem::path& file, bool whole = false);

}  // namespace granrad
