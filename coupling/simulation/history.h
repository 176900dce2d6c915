#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace granrad {

/// One row of history.csv. Flows and heats are means over the interval since the row before, the rest is the
/// state at time_s. What has no value (no particle in the region, no isothermal wall, nothing moves) is nan
/// here and an empty cell in the file.
struct HistoryRow {
  double time_s = 0, particle_count = 0, solid_fraction = 0, mean_temperature_K = 0;
  double mass_flow_in_kg_s = 0, mass_flow_out_kg_s = 0;
  double Q_ss_W = 0, Q_sfs_W = 0, Q_rad_W = 0;
  double h_ss_W_m2K = 0, h_sfs_W_m2K = 0, h_rad_W_m2K = 0, h_wp_W_m2K = 0, Nu_d = 0, energy_defect = 0;
  // beyond the contract
  double Q_rad_error_W = 0, h_wp_error_W_m2K = 0;  ///< standard errors of the ray tracing
  double region_particle_count = 0, mean_velocity_m_s = 0, outlet_temperature_K = 0, Pe_L = 0, Pe_d_star = 0;
  double coordination_number = 0, residence_time_s = 0;
};

/// A cell of a table of numbers: empty where there is no value, which pandas and spreadsheets read as
/// missing.
std::string cell(double value, int digits = 12);

/// The columns in file order: the contract's fifteen, then ours.
struct HistoryColumn {
  const char* name;
  double HistoryRow::*value;
};
const std::vector<HistoryColumn>& history_columns();

/// Appends rows; each row reaches the disk before the next is computed.
class HistoryWriter {
 public:
  /// Starts a new file, or goes on after the rows up to `last_row_s` > 0 and drops later ones. Throws IoError.
  explicit HistoryWriter(const std::filesystem::path& file, double last_row_s = 0);
  void append(const HistoryRow& row);
  /// What is wrong with the rows that were there: their last is not that of `last_row_s`. Empty when nothing is.
  const std::string& note() const { return note_; }

 private:
  std::filesystem::path file_;
  std::string note_;
};

/// A history read back: columns by name, nan where a cell is empty; an absent or empty file has no rows. Throws
/// IoError, InputError (not a history).
using History = std::map<std::string, std::vector<double>>;
History read_history(const std::filesystem::path& file);

}  // namespace granrad
