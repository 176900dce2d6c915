#include "coupling/simulation/recorder.h"

#include <cmath>
#include <limits>

#include "coupling/heat/heat_step.h"
#include "coupling/heat/wall_coefficients.h"
#include "dem/io/saved_state.h"

namespace granrad {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Contacts per particle of the region, walls not counted.
double coordination_number(const Bed& bed, const NearPairs& pairs, const std::vector<char>& inside,
                           double count) {
  double contacts = 0;
  for (const NearPair& pair : pairs.particles)
    if (pair.distance_m < bed.radius_m[pair.i] + bed.radius_m[pair.j])
      contacts += inside[pair.i] + inside[pair.j];
  return count > 0 ? contacts / count : undefined;
}

struct RegionState {
  double count = 0, mass_kg = 0, mean_velocity_m_s = undefined;  ///< velocity: downwards
};

RegionState region_state(const Bed& bed, const std::vector<char>& inside) {
  RegionState state;
  double velocities = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!inside[i]) continue;
    state.count += 1;
    state.mass_kg += mass_kg(bed, i);
    velocities -= bed.velocity_m_s[i].z;
  }
  if (state.count > 0) state.mean_velocity_m_s = velocities / state.count;
  return state;
}

/// Mean of the temperatures at both ends of an interval; of the one known where the region was empty (0 K).
double interval_temperature_K(double before, double now) {
  if (before > 0 && now > 0) return (before + now) / 2;
  return before + now > 0 ? before + now : undefined;
}

void fill_coefficients(HistoryRow& row, const Case& c, const Bed& bed, double mean_temperature_K) {
  const double diameter = bed.size() > 0 ? mean_diameter_m(bed.radius_m) : c.flow.particle_diameter_m;
  const double gas = c.heat.conduction.gas ? c.heat.conduction.gas->conductivity_W_mK : 0;
  std::optional<WallCoefficients> found;
  if (std::isfinite(mean_temperature_K))
    found = wall_coefficients(bed, {row.Q_ss_W, row.Q_sfs_W, row.Q_rad_W}, mean_temperature_K, diameter, gas);
  row.h_ss_W_m2K = found ? found->h_W_m2K.solid : undefined;
  row.h_sfs_W_m2K = found ? found->h_W_m2K.gas : undefined;
  row.h_rad_W_m2K = found ? found->h_W_m2K.radiation : undefined;
  row.h_wp_W_m2K = found ? found->h_wp_W_m2K : undefined;
  row.Nu_d = found && gas > 0 ? found->Nu_d : undefined;
  row.h_wp_error_W_m2K =
      found && row.Q_rad_W != 0 ? row.Q_rad_error_W * std::abs(row.h_rad_W_m2K / row.Q_rad_W) : undefined;

  const double length = c.flow.region.size().z;
  row.Pe_L = peclet_length(row.mean_velocity_m_s, length, c.flow.materials.front());
  row.Pe_d_star =
      gas > 0 ? peclet_modified(row.Pe_L, length, diameter, c.flow.materials.front(), gas) : undefined;
}

}  // namespace

Recorder::Mark Recorder::mark(const Bed& bed, const Flow& flow, const HeatModel& heat) const {
  const FeedTotals fed = flow.totals();
  Mark now;
  now.time_s = bed.time_s;
  now.mean_temperature_K = mean_temperature_K(bed, in_region(bed, case_.flow.region));
  now.mass_in_kg = fed.mass_in_kg;
  now.mass_out_kg = fed.mass_out_kg;
  now.heat_out_J = fed.heat_out_J;
  const HeatPaths received = heat.ledger().received_J();
  now.solid_J = received.solid;
  now.gas_J = received.gas;
  now.radiation_J = received.radiation;
  now.error_squared_W2 = heat.radiation().error_squared_W2;
  now.updates = static_cast<double>(heat.radiation().updates);
  return now;
}

void Recorder::start(const Bed& bed) {
  before_ = {};
  before_.mean_temperature_K = mean_temperature_K(bed, in_region(bed, case_.flow.region));
}

const std::vector<Recorder::MarkColumn> Recorder::mark_columns = {
    {"time_s", &Mark::time_s},
    {"mean_temperature_K", &Mark::mean_temperature_K},
    {"mass_in_kg", &Mark::mass_in_kg},
    {"mass_out_kg", &Mark::mass_out_kg},
    {"heat_out_J", &Mark::heat_out_J},
    {"solid_J", &Mark::solid_J},
    {"gas_J", &Mark::gas_J},
    {"radiation_J", &Mark::radiation_J},
    {"error_squared_W2", &Mark::error_squared_W2},
    {"updates", &Mark::updates},
};

HistoryRow Recorder::row(const Bed& bed, Flow& flow, const HeatModel& heat) {
  const Mark now = mark(bed, flow, heat);
  const double interval = now.time_s - before_.time_s;
  const auto inside = in_region(bed, case_.flow.region);
  const RegionState region = region_state(bed, inside);
  const FeedTotals fed = flow.totals();
  HistoryRow row;
  row.time_s = now.time_s;
  row.particle_count = static_cast<double>(bed.size());
  row.solid_fraction = solid_fraction(bed, case_.flow.region);
  row.mean_temperature_K = region.count > 0 ? now.mean_temperature_K : undefined;
  row.mass_flow_in_kg_s = (now.mass_in_kg - before_.mass_in_kg) / interval;
  row.mass_flow_out_kg_s = (now.mass_out_kg - before_.mass_out_kg) / interval;
  row.Q_ss_W = (now.solid_J - before_.solid_J) / interval;
  row.Q_sfs_W = (now.gas_J - before_.gas_J) / interval;
  row.Q_rad_W = (now.radiation_J - before_.radiation_J) / interval;
  row.energy_defect = heat.ledger().relative_defect(bed, fed.heat_in_J, fed.heat_out_J);

  // Updates draw their own random numbers; the view factors of a frozen bed are drawn once.
  const double updates = now.updates - before_.updates;
  const bool independent = flow.moves() || case_.heat.radiation.kind == RadiationKind::paths;
  const double variance = updates > 0 ? (now.error_squared_W2 - before_.error_squared_W2) / updates : 0;
  row.Q_rad_error_W = std::sqrt(std::max(0.0, independent && updates > 0 ? variance / updates : variance));

  row.region_particle_count = region.count;
  row.mean_velocity_m_s = region.mean_velocity_m_s;
  const double mass_out = now.mass_out_kg - before_.mass_out_kg;
  row.outlet_temperature_K = mass_out > 0 ? (now.heat_out_J - before_.heat_out_J) /
                                                (mass_out * case_.flow.materials.front().specific_heat_J_kgK)
                                          : undefined;
  row.residence_time_s = row.mass_flow_out_kg_s > 0 ? region.mass_kg / row.mass_flow_out_kg_s : undefined;
  row.coordination_number = coordination_number(bed, flow.near_pairs(bed, 0), inside, region.count);
  fill_coefficients(row, case_, bed,
                    interval_temperature_K(before_.mean_temperature_K, now.mean_temperature_K));
  before_ = now;
  return row;
}

StateBlock Recorder::save() const {
  StateBlock block;
  for (const auto& [name, value] : mark_columns) block.reals[name] = {before_.*value};
  return block;
}

void Recorder::load(const StateBlock& block) {
  for (const auto& [name, value] : mark_columns) before_.*value = saved_real(block, name);
}

}  // namespace granrad
