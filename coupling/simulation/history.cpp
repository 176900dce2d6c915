#include "coupling/simulation/history.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "coupling/simulation/case_inputs.h"
#include "dem/base/error.h"
#include "dem/base/text_file.h"

namespace granrad {

namespace {

std::string header() {
  std::string line;
  for (const auto& column : history_columns())
    line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  return line + "\n";
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

double number(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::strtod(cell.c_str(), nullptr);
}

/// The rows whose time is not after `time_s`; a row cut short by a crash is dropped.
std::string rows_up_to(const std::string& text, double time_s) {
  std::string kept;
  std::size_t begin = text.find('\n') + 1;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    if (split(line).size() == history_columns().size() &&
        std::strtod(line.c_str(), nullptr) <= time_s * (1 + 1e-9))
      kept += line + "\n";
  }
  return kept;
}

}  // namespace

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

const std::vector<HistoryColumn>& history_columns() {
  using R = HistoryRow;
  static const std::vector<HistoryColumn> columns = {
      {"time_s", &R::time_s},
      {"particle_count", &R::particle_count},
      {"solid_fraction", &R::solid_fraction},
      {"mean_temperature_K", &R::mean_temperature_K},
      {"mass_flow_in_kg_s", &R::mass_flow_in_kg_s},
      {"mass_flow_out_kg_s", &R::mass_flow_out_kg_s},
      {"Q_ss_W", &R::Q_ss_W},
      {"Q_sfs_W", &R::Q_sfs_W},
      {"Q_rad_W", &R::Q_rad_W},
      {"h_ss_W_m2K", &R::h_ss_W_m2K},
      {"h_sfs_W_m2K", &R::h_sfs_W_m2K},
      {"h_rad_W_m2K", &R::h_rad_W_m2K},
      {"h_wp_W_m2K", &R::h_wp_W_m2K},
      {"Nu_d", &R::Nu_d},
      {"energy_defect", &R::energy_defect},
      {"Q_rad_error_W", &R::Q_rad_error_W},
      {"h_wp_error_W_m2K", &R::h_wp_error_W_m2K},
      {"region_particle_count", &R::region_particle_count},
      {"mean_velocity_m_s", &R::mean_velocity_m_s},
      {"outlet_temperature_K", &R::outlet_temperature_K},
      {"Pe_L", &R::Pe_L},
      {"Pe_d_star", &R::Pe_d_star},
      {"coordination_number", &R::coordination_number},
      {"residence_time_s", &R::residence_time_s},
  };
  return columns;
}

HistoryWriter::HistoryWriter(const std::filesystem::path& file, double last_row_s) : file_(file) {
  std::string rows;
  if (last_row_s > 0 && std::filesystem::exists(file)) rows = rows_up_to(read_text_file(file), last_row_s);
  const auto last_line = rows.size() < 2 ? std::string::npos : rows.rfind('\n', rows.size() - 2);
  const double reached_s =
      rows.empty()
          ? 0
          : std::strtod(rows.c_str() + (last_line == std::string::npos ? 0 : last_line + 1), nullptr);
  if (std::abs(reached_s - last_row_s) > 1e-9 * last_row_s)
    note_ = fmt::format("{}: its rows end at {:g} s, the run goes on at {:g} s: rows between are missing",
                        file.string(), reached_s, last_row_s);
  write_text_file(file, header() + rows);
}

void HistoryWriter::append(const HistoryRow& row) {
  std::string line;
  for (const auto& column : history_columns()) {
    if (!line.empty()) line += ',';
    line += cell(row.*column.value);
  }
  line += "\n";
  std::FILE* out = std::fopen(file_.c_str(), "ab");
  if (!out) throw IoError(fmt::format("{}: cannot be written", file_.string()));
  const bool written = std::fwrite(line.data(), 1, line.size(), out) == line.size() &&
                       std::fflush(out) == 0 && fsync(fileno(out)) == 0;
  if (std::fclose(out) != 0 || !written) throw IoError(fmt::format("{}: cannot be written", file_.string()));
}

History read_history(const std::filesystem::path& file) {
  std::stringstream text(std::filesystem::exists(file) ? read_text_file(file) : "");
  std::string line;
  if (!std::getline(text, line)) line = "time_s";
  const auto names = split(line);
  if (names.empty() || names.front() != "time_s")
    throw InputError(fmt::format("{} (not a history: the first column must be time_s)", file.string()));
  History history;
  for (const auto& name : names) history[name];
  while (std::getline(text, line)) {
    const auto cells = split(line);
    if (cells.size() != names.size()) continue;  // a row being written now
    for (std::size_t k = 0; k < names.size(); ++k) history[names[k]].push_back(number(cells[k]));
  }
  return history;
}

}  // namespace granrad
