#include "coupling/simulation/wall_history.h"

#include <fmt/core.h>

#include "dem/base/files/csv.h"

namespace granrad {

namespace {

const char* const header = "time_s,wall,area_m2,temperature_K,Q_ss_W,Q_sfs_W,Q_rad_W";
constexpr std::size_t cell_count = 7;

}  // namespace

WallHistoryWriter::WallHistoryWriter(const std::filesystem::path& file, double last_row_s)
    : log_(file, header, last_row_s) {}

void WallHistoryWriter::append(const std::vector<WallRow>& rows) {
  std::string text;
  for (const auto& row : rows)
    text += fmt::format("{},{},{},{},{},{},{}\n", cell(row.time_s), text_cell(row.wall), cell(row.area_m2),
                        cell(row.temperature_K), cell(row.Q_ss_W), cell(row.Q_sfs_W), cell(row.Q_rad_W));
  log_.append(text);
}

std::vector<WallRow> read_wall_history(const std::filesystem::path& file) {
  std::vector<WallRow> rows;
  if (!std::filesystem::exists(file)) return rows;
  const CsvTable table = read_csv(file);
  for (const auto& cells : table.rows) {
    if (cells.size() != cell_count) continue;  // of a program with other columns
    const auto number = [&](std::size_t k) { return cell_number(cells[k]); };
    rows.push_back({number(0), cells[1], number(2), number(3), number(4), number(5), number(6)});
  }
  return rows;
}

}  // namespace granrad
