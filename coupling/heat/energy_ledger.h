#pragma once
#include "coupling/heat/heat_step.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// A sum that remembers what rounding took (Neumaier, Z. angew. Math. Mech. 54 (1974) 39): its
/// error does not grow with the number of terms.
class CompensatedSum {
 public:
  void add(double term);
  double value() const { return sum_ + lost_; }
  double sum() const { return sum_; }
  double lost() const { return lost_; }
  static CompensatedSum restored(double sum, double lost);

 private:
  double sum_ = 0, lost_ = 0;
};

/// Sums of heats, each path apart.
class PathSums {
 public:
  PathSums() : of_path_(HeatPaths::paths().size()) {}
  void add(const HeatPaths& heat);
  HeatPaths values() const;

  void save(StateBlock& block) const;
  void load(const StateBlock& block);

 private:
  std::vector<CompensatedSum> of_path_;  ///< as HeatPaths::paths
};

/// Energy received against energy stored, from time 0. The two sides are computed apart: `received` from the
/// heats of every step, `stored` from the temperatures, so their difference checks the whole chain.
class EnergyLedger {
 public:
  /// Opens the books on the bed at time 0.
  void start(const Bed& bed);
  /// Books the heat one step brought (result of advance_temperatures), J.
  void receive(const HeatPaths& heat_J);
  /// Heat the radiating walls gave and no particle got, J: W left over by the exchange source times the step.
  /// 0 for conserving sources; row_sum closure and net sinks show here and hence in the defect.
  void miss(double heat_J);

  HeatPaths received_J() const;
  /// sum m c T now, minus at time 0, minus brought in by the feed, plus carried out with removed particles.
  double stored_J(const Bed& bed, double feed_in_J, double feed_out_J) const;
  /// |stored - received - missed| / |received|; relative to 1e-5 of the energy of the bed where less was received; 0 when
  /// nothing moved.
  double relative_defect(const Bed& bed, double feed_in_J, double feed_out_J) const;

  StateBlock save() const;
  void load(const StateBlock& block);  ///< throws InputError when a column is missing

 private:
  double energy_at_start_J_ = 0;
  PathSums received_;
  CompensatedSum missed_;
};

}  // namespace granrad
