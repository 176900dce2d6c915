#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dem/base/files/csv_log.h"

namespace granrad {

/// One wall in one row of walls.csv: heat it gave, W, mean over the interval since the row before. Through contacts
/// and gas that is what particles received from it; by radiation its net emission, so that the sum over the walls
/// is what the particles received. The surroundings stand last, with no area and no temperature of their own.
struct WallRow {
  double time_s = 0;
  std::string wall;
  double area_m2 = 0;  ///< inside the heat-transfer region
  double temperature_K = 0;
  double Q_ss_W = 0, Q_sfs_W = 0, Q_rad_W = 0;
};

/// Appends to walls.csv: time_s,wall,area_m2,temperature_K,Q_ss_W,Q_sfs_W,Q_rad_W.
class WallHistoryWriter {
 public:
  WallHistoryWriter(const std::filesystem::path& file, double last_row_s);  ///< see CsvLog
  void append(const std::vector<WallRow>& rows);

 private:
  CsvLog log_;
};

/// The rows of a walls.csv; none where there is no file. Throws IoError.
std::vector<WallRow> read_wall_history(const std::filesystem::path& file);

}  // namespace granrad
