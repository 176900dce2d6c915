#pragma once
#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_model.h"
#include "coupling/simulation/history.h"
#include "coupling/simulation/wall_history.h"

namespace granrad {

/// What one interval adds to history.csv and walls.csv.
struct Record {
  HistoryRow row;
  std::vector<WallRow> walls;
};

/// Makes the rows of history.csv and walls.csv: means over the interval since the rows before, from totals.
class Recorder {
 public:
  explicit Recorder(const Case& c) : case_(c) {}
  /// The first interval begins with this bed.
  void start(const Bed& bed);
  Record record(const Bed& bed, Flow& flow, const HeatModel& heat);

  double last_row_s() const { return before_.time_s; }
  StateBlock save() const;
  void load(const StateBlock& block);

 private:
  /// Totals at the row before.
  struct Mark {
    double time_s = 0, mean_temperature_K = 0;  ///< 0: no particle in the region
    double mass_in_kg = 0, mass_out_kg = 0, heat_out_J = 0, heat_capacity_out_J_K = 0;
    double solid_J = 0, gas_J = 0, radiation_J = 0;  ///< received by the particles
    double error_squared_W2 = 0, updates = 0, lost_rays = 0;
    std::vector<HeatPaths> from_walls_J;
  };
  struct MarkColumn {
    const char* name;
    double Mark::*value;
  };
  static const std::vector<MarkColumn> mark_columns;  ///< what a frame keeps of it, beside the walls
  Mark mark(const Bed& bed, const Flow& flow, const HeatModel& heat) const;
  void fill_flows(HistoryRow& row, const Mark& now) const;
  void fill_heats(HistoryRow& row, const Mark& now, bool independent_updates) const;
  std::vector<WallRow> wall_rows(const Bed& bed, const Mark& now) const;

  const Case& case_;
  Mark before_;
};

}  // namespace granrad
