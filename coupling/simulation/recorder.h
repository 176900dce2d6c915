#pragma once
#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_model.h"
#include "coupling/simulation/history.h"

namespace granrad {

/// Makes the rows of history.csv: means over the interval since the row before, from totals.
class Recorder {
 public:
  explicit Recorder(const Case& c) : case_(c) {}
  /// The first interval begins with this bed.
  void start(const Bed& bed);
  HistoryRow row(const Bed& bed, Flow& flow, const HeatModel& heat);

  double last_row_s() const { return before_.time_s; }
  StateBlock save() const;
  void load(const StateBlock& block);

 private:
  /// Totals at the row before.
  struct Mark {
    double time_s = 0, mean_temperature_K = 0;  ///< 0: no particle in the region
    double mass_in_kg = 0, mass_out_kg = 0, heat_out_J = 0;
    double solid_J = 0, gas_J = 0, radiation_J = 0;  ///< received by the particles
    double error_squared_W2 = 0, updates = 0;
  };
  struct MarkColumn {
    const char* name;
    double Mark::*value;
  };
  static const std::vector<MarkColumn> mark_columns;  ///< what a frame keeps of it
  Mark mark(const Bed& bed, const Flow& flow, const HeatModel& heat) const;

  const Case& case_;
  Mark before_;
};

}  // namespace granrad
