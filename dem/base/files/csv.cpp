#include "dem/base/files/csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

std::string text_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') {
      if (quoted && k + 1 < line.size() && line[k + 1] == '"')
        cells.back() += line[k++];
      else
        quoted = !quoted;
    } else if (line[k] == ',' && !quoted) {
      cells.emplace_back();
    } else if (line[k] != '\r') {
      cells.back() += line[k];
    }
  }
  return cells;
}

double cell_number(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return cell.empty() || *end != '\0' ? std::numeric_limits<double>::quiet_NaN() : value;
}

std::size_t CsvTable::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nowhere : static_cast<std::size_t>(found - names.begin());
}

std::size_t CsvTable::column(const std::string& name) const {
  const std::size_t place = find(name);
  if (place == nowhere) throw InputError(fmt::format("{}: has no column {}", file, name));
  return place;
}

std::vector<double> CsvTable::numbers(const std::string& name) const {
  const std::size_t place = column(name);
  std::vector<double> all;
  for (const auto& row : rows) all.push_back(cell_number(row[place]));
  return all;
}

CsvTable read_csv(const std::filesystem::path& file, bool whole) {
  CsvTable table;
  table.file = file.string();
  std::stringstream text(read_text_file(file));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    auto cells = split_cells(line);
    if (table.names.empty()) {
      table.names = std::move(cells);
      continue;
    }
    if (cells.size() == table.names.size()) {
      table.rows.push_back(std::move(cells));
      table.line.push_back(number);
    } else if (whole) {
      throw InputError(fmt::format("{}:{}: {} cells for {} columns", table.file, number, cells.size(),
                                   table.names.size()));
    }
  }
  return table;
}

}  // namespace granrad
