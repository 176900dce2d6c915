#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/heat/energy_ledger.h"
#include "coupling/heat/heat_limits.h"
#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_scene.h"
#include "coupling/simulation/wall_heats.h"
#include "dem/base/constants.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// Sums over radiation updates, for standard errors and the closure of the books.
struct RadiationTotals {
  std::int64_t updates = 0, rays = 0;
  std::int64_t lost_rays = 0;     ///< that met the back of a wall or did not end
  double wall_heat_W = 0;         ///< given by isothermal and open walls at the last update
  double missed_W = 0;            ///< given by walls and got by no particle, held until the next update
  double error_squared_W2 = 0;    ///< sum over updates of the squared standard error of the wall heat
  double closure_correction = 0;  ///< largest so far
  double reciprocity_rms = 0;     ///< of the view factors of the last update
  double absolute_heat_W = 0;     ///< sum over updates of |wall heat|
  double limited_share =
      0;  ///< largest share of the heats that had to be moved to keep temperatures within bounds
  std::int64_t implicit_updates = 0;  ///< those too long for the heats of their middle
};

/// Heat of the bed: conduction and held radiation, one step at a time, with its ledger. Builds only
/// what the scene needs: without radiation no source, without gas and contacts no pairs.
class HeatModel {
 public:
  HeatModel(const Case& c, int threads = 0);
  /// Opens the books on the bed at time 0.
  void start(const Bed& bed) {
    ledger_.start(bed);
    walls_.start(bed);
  }

  /// Conductances of the bed as it is; those of a frozen bed are kept. Empty when nothing conducts.
  const Conductances& conduct(const Bed& bed, Flow& flow);
  /// Net radiative heat of every particle into bed.radiative_heat_W, to be held for `interval_s`.
  void radiate(Bed& bed, double interval_s);
  /// Net radiative heat of every particle of the bed as it is, W, and its standard error (empty: not known);
  /// random numbers by `draw`. Changes nothing in the bed or the books. 0 for particles outside the region.
  struct ParticleHeat {
    std::vector<double> heat_W, standard_error_W;
    RadiativeHeat all;  ///< by surface
  };
  ParticleHeat draw_radiation(const Bed& bed, std::uint64_t draw);
  /// One heat step with what conduct and radiate found. Throws NumericalError.
  void advance(Bed& bed, double dt_s);

  const EnergyLedger& ledger() const { return ledger_; }
  const RadiationTotals& radiation() const { return radiation_; }
  const WallHeats& walls() const { return walls_; }
  StateBlock save() const;
  StateBlock save_ledger() const { return ledger_.save(); }
  StateBlock save_walls() const { return walls_.save(); }
  void load_walls(const StateBlock& walls) { walls_.load(walls); }
  void load(const StateBlock& radiation, const StateBlock& ledger);

 private:
  RadiativeHeat draw_heats(const Enclosure& enclosure, const RadiativeState& state, std::uint64_t draw);
  /// The state a source is asked for, and where conduction alone leads.
  struct Ahead {
    RadiativeState state;
    ConductedTemperatures conducted;
  };
  Ahead look_ahead(const Bed& bed, const Enclosure& enclosure) const;
  /// What the temperature of each particle, `from_K`, makes of its heat until the next update
  /// (RadiativeState::relaxation).
  void add_relaxation(const Bed& bed, const std::vector<double>& from_K, const Enclosure& enclosure,
                      RadiativeState& state) const;
  double wanted_error_W(const Enclosure& enclosure, const RadiativeState& state, std::uint64_t update);

  const Case& case_;
  int threads_;
  std::unique_ptr<ExchangeSource> source_;  ///< made at the first update
  Conductances conductances_;
  double conductances_until_s_ = -infinity;  ///< of a frozen bed: until a shutter opens
  EnergyLedger ledger_;
  WallHeats walls_;
  RadiationTotals radiation_;
  double interval_s_ = 0;  ///< of the present radiation update
};

/// 1 for the particles whose centre lies in `region` (in the periodic image inside the box, as everywhere).
std::vector<char> in_region(const Bed& bed, const Box& region);

}  // namespace granrad
