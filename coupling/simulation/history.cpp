#include "coupling/simulation/history.h"

#include <fmt/core.h>

#include <cstdlib>
#include <sstream>

#include "coupling/simulation/case_inputs.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

std::string header() {
  std::string line;
  for (const auto& column : history_column_list)
    line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  return line;
}

double number(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::strtod(cell.c_str(), nullptr);
}

}  // namespace

HistoryWriter::HistoryWriter(const std::filesystem::path& file, double last_row_s)
    : log_(file, header(), last_row_s) {}

void HistoryWriter::append(const HistoryRow& row) {
  std::string line;
  for (const double value : row.values()) {
    if (!line.empty()) line += ',';
    line += cell(value);
  }
  log_.append(line + "\n");
}

History read_history(const std::filesystem::path& file) {
  std::stringstream text(std::filesystem::exists(file) ? read_text_file(file) : "");
  std::string line;
  if (!std::getline(text, line)) line = "time_s";
  const auto names = split_cells(line);
  if (names.front() != "time_s")
    throw InputError(fmt::format("{} (not a history: the first column must be time_s)", file.string()));
  History history;
  for (const auto& name : names) history[name];
  while (std::getline(text, line)) {
    const auto cells = split_cells(line);
    if (cells.size() != names.size()) continue;  // a row being written now
    for (std::size_t k = 0; k < names.size(); ++k) history[names[k]].push_back(number(cells[k]));
  }
  return history;
}

}  // namespace granrad
