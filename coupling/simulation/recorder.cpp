#include "coupling/simulation/recorder.h"

#include <cmath>
#include <limits>
#include <optional>

#include "coupling/heat/heat_step.h"
#include "coupling/heat/wall_area.h"
#include "coupling/heat/wall_coefficients.h"
#include "dem/bed/solid_fraction.h"
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

double bed_diameter_m(const Bed& bed, double fallback) {
  if (bed.size() == 0) return fallback;
  double sum = 0;
  for (double radius : bed.radius_m) sum += radius;
  return 2 * sum / static_cast<double>(bed.size());
}

void fill_peclet(HistoryRow& row, const Case& c, double diameter_m) {
  const double length = c.flow.region.size().z;
  const double gas = c.heat.conduction.gas ? c.heat.conduction.gas->conductivity_W_mK : 0;
  row["Pe_L"] = peclet_length(row["mean_velocity_m_s"], length, c.flow.materials.front());
  if (gas > 0)
    row["Pe_d_star"] = peclet_modified(row["Pe_L"], length, diameter_m, c.flow.materials.front(), gas);
}

void fill_coefficients(HistoryRow& row, const Case& c, const Bed& bed, double mean_temperature_K) {
  const double diameter = bed_diameter_m(bed, c.flow.particle_diameter_m);
  fill_peclet(row, c, diameter);
  if (!std::isfinite(mean_temperature_K)) return;
  const auto found = wall_coefficients(bed, c.flow.region, {row["Q_ss_W"], row["Q_sfs_W"], row["Q_rad_W"]},
                                       mean_temperature_K);
  if (!found) return;
  const HeatPaths& h = found->h_W_m2K;
  row["h_ss_W_m2K"] = h.solid;
  row["h_sfs_W_m2K"] = h.gas;
  row["h_rad_W_m2K"] = h.radiation;
  row["h_wp_W_m2K"] = h.total();
  row["h_wp_error_W_m2K"] = row["Q_rad_error_W"] * std::abs(found->per_watt);
  if (h.total() != 0) {
    row["share_ss"] = h.solid / h.total();
    row["share_sfs"] = h.gas / h.total();
    row["share_rad"] = h.radiation / h.total();
  }
  if (!c.heat.conduction.gas) return;
  const double scale = diameter / c.heat.conduction.gas->conductivity_W_mK;
  row["Nu_d"] = h.total() * scale;
  row["Nu_d_ss"] = h.solid * scale;
  row["Nu_d_sfs"] = h.gas * scale;
  row["Nu_d_rad"] = h.radiation * scale;
  row["Nu_d_error"] = row["h_wp_error_W_m2K"] * scale;
}

}  // namespace

const std::vector<Recorder::MarkColumn> Recorder::mark_columns = {
    {"time_s", &Mark::time_s},           {"mean_temperature_K", &Mark::mean_temperature_K},
    {"mass_in_kg", &Mark::mass_in_kg},   {"mass_out_kg", &Mark::mass_out_kg},
    {"heat_out_J", &Mark::heat_out_J},   {"heat_capacity_out_J_K", &Mark::heat_capacity_out_J_K},
    {"solid_J", &Mark::solid_J},         {"gas_J", &Mark::gas_J},
    {"radiation_J", &Mark::radiation_J}, {"error_squared_W2", &Mark::error_squared_W2},
    {"updates", &Mark::updates},         {"lost_rays", &Mark::lost_rays},
};

Recorder::Mark Recorder::mark(const Bed& bed, const Flow& flow, const HeatModel& heat) const {
  const FeedTotals fed = flow.totals();
  const HeatPaths received = heat.ledger().received_J();
  Mark now;
  now.time_s = bed.time_s;
  now.mean_temperature_K = mean_temperature_K(bed, in_region(bed, case_.flow.region));
  now.mass_in_kg = fed.mass_in_kg;
  now.mass_out_kg = fed.mass_out_kg;
  now.heat_out_J = fed.heat_out_J;
  now.heat_capacity_out_J_K = fed.heat_capacity_out_J_K;
  now.solid_J = received.solid;
  now.gas_J = received.gas;
  now.radiation_J = received.radiation;
  now.error_squared_W2 = heat.radiation().error_squared_W2;
  now.updates = static_cast<double>(heat.radiation().updates);
  now.lost_rays = static_cast<double>(heat.radiation().lost_rays);
  now.from_walls_J = heat.walls().given_J();
  return now;
}

void Recorder::start(const Bed& bed) {
  before_ = {};
  before_.time_s = bed.time_s;
  before_.mean_temperature_K = mean_temperature_K(bed, in_region(bed, case_.flow.region));
  before_.from_walls_J.assign(bed.walls.size() + 1, {});
}

void Recorder::fill_flows(HistoryRow& row, const Mark& now) const {
  const double interval = now.time_s - before_.time_s;
  const double capacity_out = now.heat_capacity_out_J_K - before_.heat_capacity_out_J_K;
  row["mass_flow_in_kg_s"] = (now.mass_in_kg - before_.mass_in_kg) / interval;
  row["mass_flow_out_kg_s"] = (now.mass_out_kg - before_.mass_out_kg) / interval;
  row["heat_out_W"] = (now.heat_out_J - before_.heat_out_J) / interval;
  if (capacity_out > 0) row["outlet_temperature_K"] = (now.heat_out_J - before_.heat_out_J) / capacity_out;
}

void Recorder::fill_heats(HistoryRow& row, const Mark& now, bool independent_updates) const {
  const double interval = now.time_s - before_.time_s, updates = now.updates - before_.updates;
  row["Q_ss_W"] = (now.solid_J - before_.solid_J) / interval;
  row["Q_sfs_W"] = (now.gas_J - before_.gas_J) / interval;
  row["Q_rad_W"] = (now.radiation_J - before_.radiation_J) / interval;
  if (case_.heat.radiation.kind != RadiationKind::none) row["lost_rays"] = now.lost_rays - before_.lost_rays;
  if (case_.heat.radiation.kind == RadiationKind::correlation) return;  // a table does not know its error
  const double variance = updates > 0 ? (now.error_squared_W2 - before_.error_squared_W2) / updates : 0;
  row["Q_rad_error_W"] =
      std::sqrt(std::max(0.0, independent_updates && updates > 0 ? variance / updates : variance));
}

std::vector<WallRow> Recorder::wall_rows(const Bed& bed, const Mark& now) const {
  const double interval = now.time_s - before_.time_s;
  const auto row = [&](std::size_t w, const std::string& name, double area_m2, double temperature_K) {
    const HeatPaths &after = now.from_walls_J[w], &before = before_.from_walls_J[w];
    return WallRow{now.time_s,
                   name,
                   area_m2,
                   temperature_K,
                   (after.solid - before.solid) / interval,
                   (after.gas - before.gas) / interval,
                   (after.radiation - before.radiation) / interval};
  };
  std::vector<WallRow> rows;
  for (std::size_t w = 0; w < bed.walls.size(); ++w)
    rows.push_back(
        row(w, bed.walls[w].name, area_inside(bed.walls[w], case_.flow.region), bed.walls[w].temperature_K));
  if (case_.heat.radiation.kind != RadiationKind::none)
    rows.push_back(row(bed.walls.size(), "surroundings", 0, undefined));
  return rows;
}

Record Recorder::record(const Bed& bed, Flow& flow, const HeatModel& heat) {
  const Mark now = mark(bed, flow, heat);
  const auto inside = in_region(bed, case_.flow.region);
  const RegionState region = region_state(bed, inside);
  const FeedTotals fed = flow.totals();
  Record record;
  HistoryRow& row = record.row;
  row["time_s"] = now.time_s;
  row["particle_count"] = static_cast<double>(bed.size());
  row["solid_fraction"] = solid_fraction(bed, case_.flow.region);
  if (region.count > 0) row["mean_temperature_K"] = now.mean_temperature_K;
  fill_flows(row, now);
  // Updates draw their own random numbers; the view factors of a frozen bed are drawn once.
  fill_heats(row, now, flow.moves() || case_.heat.radiation.kind == RadiationKind::paths);
  row["energy_defect"] = heat.ledger().relative_defect(bed, fed.heat_in_J, fed.heat_out_J);
  row["region_particle_count"] = region.count;
  row["mean_velocity_m_s"] = region.mean_velocity_m_s;
  if (row["mass_flow_out_kg_s"] > 0) row["residence_time_s"] = region.mass_kg / row["mass_flow_out_kg_s"];
  row["coordination_number"] = coordination_number(bed, flow.near_pairs(bed, 0), inside, region.count);
  fill_coefficients(row, case_, bed,
                    interval_temperature_K(before_.mean_temperature_K, now.mean_temperature_K));
  record.walls = wall_rows(bed, now);
  before_ = now;
  return record;
}

StateBlock Recorder::save() const {
  StateBlock block;
  for (const auto& [name, value] : mark_columns) block.reals[name] = {before_.*value};
  save_paths(block, "from_walls", before_.from_walls_J);
  return block;
}

void Recorder::load(const StateBlock& block) {
  for (const auto& [name, value] : mark_columns) before_.*value = saved_real(block, name);
  before_.from_walls_J = saved_paths(block, "from_walls");
}

}  // namespace granrad
