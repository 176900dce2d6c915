#pragma once
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dem/base/files/csv_log.h"

namespace granrad {

/// A column of history.csv: its name with its unit, and what it means.
struct HistoryColumn {
  const char *name, *meaning;
};

/// The columns in file order: the contract's fifteen, then ours. Flows and heats are means over the interval since
/// the row before, the rest is the state at time_s. A new column is a line here and its value in recorder.cpp.
inline constexpr HistoryColumn history_column_list[] = {
    {"time_s", "end of the interval"},
    {"particle_count", "particles there are"},
    {"solid_fraction", "volume of the particles in the region over its volume"},
    {"mean_temperature_K", "number average in the region"},
    {"mass_flow_in_kg_s", "fed"},
    {"mass_flow_out_kg_s", "left or removed"},
    {"Q_ss_W", "from the walls through contacts"},
    {"Q_sfs_W", "from the walls through the gas"},
    {"Q_rad_W", "by radiation, all that the particles received"},
    {"h_ss_W_m2K", "wall coefficient through contacts"},
    {"h_sfs_W_m2K", "wall coefficient through the gas"},
    {"h_rad_W_m2K", "wall coefficient of radiation"},
    {"h_wp_W_m2K", "wall coefficient, all three"},
    {"Nu_d", "h_wp d / k_gas"},
    {"energy_defect", "|stored - received| / received since time 0"},
    {"Q_rad_error_W", "standard error of Q_rad_W by ray tracing"},
    {"h_wp_error_W_m2K", "standard error of h_wp by ray tracing"},
    {"region_particle_count", "particles in the region"},
    {"mean_velocity_m_s", "downwards, number average in the region"},
    {"outlet_temperature_K", "of what left, by heat capacity"},
    {"Pe_L", "Peclet number of the region's height"},
    {"Pe_d_star", "modified Peclet number"},
    {"coordination_number", "contacts per particle of the region"},
    {"residence_time_s", "mass in the region over mass flow out"},
    {"Nu_d_ss", "h_ss d / k_gas"},
    {"Nu_d_sfs", "h_sfs d / k_gas"},
    {"Nu_d_rad", "h_rad d / k_gas"},
    {"Nu_d_error", "standard error of Nu_d by ray tracing"},
    {"share_ss", "h_ss / h_wp"},
    {"share_sfs", "h_sfs / h_wp"},
    {"share_rad", "h_rad / h_wp"},
    {"heat_out_W", "m c T of what left or was removed"},
    {"lost_rays", "that met the back of a wall or did not end; more than 1 in 1000 stop the run"},
};

inline std::span<const HistoryColumn> history_columns() {
  return history_column_list;
}

/// The number of a column, found when the program is compiled: a name that is none does not compile.
struct HistoryKey {
  std::size_t index;
  consteval HistoryKey(const char* name) : index(0) {
    while (std::string_view(history_column_list[index].name) != name) ++index;
  }
};

/// One row of history.csv. What has no value (no particle in the region, no hot wall, nothing moves) is nan here
/// and an empty cell in the file.
class HistoryRow {
 public:
  HistoryRow() { values_.fill(std::numeric_limits<double>::quiet_NaN()); }
  double& operator[](HistoryKey key) { return values_[key.index]; }
  double operator[](HistoryKey key) const { return values_[key.index]; }
  const auto& values() const { return values_; }

 private:
  std::array<double, std::size(history_column_list)> values_;
};

/// Appends rows to history.csv.
class HistoryWriter {
 public:
  HistoryWriter(const std::filesystem::path& file, double last_row_s);  ///< see CsvLog
  void append(const HistoryRow& row);
  const std::string& note() const { return log_.note(); }

 private:
  CsvLog log_;
};

/// A history read back: columns by name, nan where a cell is empty; an absent or empty file has no rows. Throws
/// IoError, InputError (not a history).
using History = std::map<std::string, std::vector<double>>;
History read_history(const std::filesystem::path& file);

}  // namespace granrad
