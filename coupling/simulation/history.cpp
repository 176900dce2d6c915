#include "coupling/simulation/history.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/base/files/csv.h"

namespace granrad {

namespace {

std::string header() {
  std::string line;
  for (const auto& column : history_column_list)
    line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  return line;
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
  CsvTable table;
  if (std::filesystem::exists(file)) table = read_csv(file);
  if (table.names.empty()) table.names = {"time_s"};
  if (table.names.front() != "time_s")
    throw InputError(fmt::format("{} (not a history: the first column must be time_s)", file.string()));
  History history;
  for (const auto& name : table.names) history[name] = table.numbers(name);
  return history;
}

}  // namespace granrad
