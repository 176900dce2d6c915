#include "coupling/simulation/heat_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "coupling/heat/heat_limits.h"
#include "coupling/heat/heat_step.h"
#include "coupling/simulation/radiation_check.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/io/saved_state.h"
#include "dem/ranks/ranks.h"

BOOST_HANA_ADAPT_STRUCT(granrad::RadiationTotals, updates, rays, lost_rays, implicit_updates, wall_heat_W,
                        missed_W, error_squared_W2, closure_correction, reciprocity_rms, absolute_heat_W,
                        limited_share);

namespace granrad {

namespace {

double sum(const std::vector<double>& values) {
  CompensatedSum total;
  for (double value : values) total.add(value);
  return total.value();
}

double hottest_radiating_K(const Bed& bed, const Enclosure& enclosure, double surroundings_K) {
  double hottest = surroundings_K;
  for (const std::int32_t i : enclosure.particle) hottest = std::max(hottest, bed.temperature_K[i]);
  for (const Wall& wall : enclosure.walls)
    if (wall.role == WallRole::isothermal || wall.role == WallRole::open)
      hottest = std::max(hottest, wall.temperature_K);
  return hottest;
}

/// Whether all that radiates is equally warm: nothing is exchanged, whatever sees what.
bool is_isothermal(const RadiativeState& state) {
  std::optional<double> power;
  for (std::size_t s = 0; s < state.emissivity.size(); ++s) {
    if (!state.radiates(s)) continue;
    if (power && *power != state.emissive_power_W_m2[s]) return false;
    power = state.emissive_power_W_m2[s];
  }
  return true;
}

/// What the ranks found of their parts of the pairs, in the order of one process: the same on every rank, so that a pair's
/// heat is one number there too.
Conductances joined(const Conductances& own, std::size_t particles) {
  Conductances all{
      sorted_by_rows(std::vector<std::vector<PairConductance>>{joined_over_ranks(own.particles)}, particles),
      joined_over_ranks(own.walls)};
  std::stable_sort(all.walls.begin(), all.walls.end(),
                   [](const WallConductance& a, const WallConductance& b) { return a.i < b.i; });
  return all;
}

/// Throws NumericalError when a heat is not a number.
HeatModel::ParticleHeat by_particle(const Bed& bed, const Enclosure& enclosure, RadiativeHeat all) {
  const auto to_particles = [&](const std::vector<double>& by_surface) {
    std::vector<double> values(by_surface.empty() ? 0 : bed.size(), 0.0);
    for (std::size_t k = 0; k < enclosure.particle.size() && !by_surface.empty(); ++k)
      values[enclosure.particle[k]] = by_surface[k];
    return values;
  };
  HeatModel::ParticleHeat result{to_particles(all.heat_W), to_particles(all.standard_error_W),
                                 std::move(all)};
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (!std::isfinite(result.heat_W[i]))
      throw NumericalError(
          fmt::format("radiative heat of particle {} is not a number at {:g} s", bed.id[i], bed.time_s));
  return result;
}

/// Where nothing says it, the walls close (check_radiation saw to it) and no ray asks.
double surroundings_K(const Case& c) {
  return known_surroundings_K(c.flow, c.heat.surroundings_K).value_or(c.flow.particle_temperature_K);
}

}  // namespace

HeatModel::HeatModel(const Case& c, int threads) : case_(c), threads_(threads) {}

const Conductances& HeatModel::conduct(const Bed& bed, Flow& flow) {
  const ConductionSettings& settings = case_.heat.conduction;
  if (!settings.solid && !settings.gas) return conductances_;
  if (!flow.moves() && bed.time_s < conductances_until_s_) return conductances_;
  const double largest = bed.size() ? *std::max_element(bed.radius_m.begin(), bed.radius_m.end()) : 0;
  const double gap_m = lens_cutoff_gap_m(settings, largest);
  const auto inside = in_region(bed, case_.flow.region);
  const auto touches = settings.solid && !settings.rough ? flow.touches(bed) : std::nullopt;
  const bool needs_pairs = !touches || settings.gas;
  if (rank_count() > 1 && !touches && flow.searches_pairs())
    conductances_ =
        joined(conductances(bed, near_pairs(bed, gap_m, rank(), rank_count()), settings, inside), bed.size());
  else
    conductances_ = conductances(bed, needs_pairs ? flow.near_pairs(bed, gap_m) : NearPairs{}, settings,
                                 inside, touches ? &*touches : nullptr);
  conductances_until_s_ = next_opening_s(bed.walls, bed.time_s);
  return conductances_;
}

HeatModel::ParticleHeat HeatModel::draw_radiation(const Bed& bed, std::uint64_t draw) {
  const Enclosure enclosure = make_enclosure(bed, case_.flow.region);
  RadiativeState state = radiative_state(bed, bed.temperature_K, enclosure, surroundings_K(case_));
  if (interval_s_ > 0) add_relaxation(bed, bed.temperature_K, enclosure, state);
  return by_particle(bed, enclosure, draw_heats(enclosure, state, draw));
}

RadiativeHeat HeatModel::draw_heats(const Enclosure& enclosure, const RadiativeState& state,
                                    std::uint64_t draw) {
  if (is_isothermal(state)) {
    RadiativeHeat none;
    none.heat_W.assign(enclosure.surface_count(), 0);
    none.standard_error_W.assign(enclosure.surface_count(), 0);
    return none;
  }
  if (!source_) source_ = make_radiation_source(case_.heat.radiation, case_.flow, threads_);
  return source_->net_heat(enclosure, state, draw);
}

/// The state for the coming interval. Short ones: temperatures of its middle, of second order. Long ones: the emission
/// of its end, linearised (see heat_step.h), from where conduction leads by then: a particle that conduction warms faster
/// than the interval emits as the warm one it is.
HeatModel::Ahead HeatModel::look_ahead(const Bed& bed, const Enclosure& enclosure) const {
  const double around_K = surroundings_K(case_);
  const double hottest_K = hottest_radiating_K(bed, enclosure, around_K);
  const bool implicit =
      interval_s_ > explicit_radiation_fraction * (1 + 1e-6) * radiation_time_constant_s(bed, hottest_K);
  const auto bounds =
      temperature_bounds(bed, conductances_, radiative_state(bed, bed.temperature_K, enclosure, around_K));
  Ahead ahead;
  ahead.conducted =
      conducted_temperatures(bed, conductances_, implicit ? interval_s_ : 0.5 * interval_s_, bounds);
  const auto& conducted_K = ahead.conducted.end_K;
  const auto ahead_K = implicit ? conducted_K : midway_temperatures_K(bed, conducted_K, interval_s_);
  ahead.state = radiative_state(bed, ahead_K, enclosure, around_K);
  add_relaxation(bed, implicit ? conducted_K : bed.temperature_K, enclosure, ahead.state);
  ahead.state.implicit = implicit;
  return ahead;
}

void HeatModel::add_relaxation(const Bed& bed, const std::vector<double>& from_K, const Enclosure& enclosure,
                               RadiativeState& state) const {
  double hottest_K = hottest_radiating_K(bed, enclosure, surroundings_K(case_));
  for (const std::int32_t i : enclosure.particle)
    hottest_K = std::max(hottest_K, from_K[static_cast<std::size_t>(i)]);
  const auto relaxation = radiative_relaxation(bed, from_K, hottest_K, interval_s_);
  state.relaxation.assign(enclosure.surface_count(), 0);
  for (std::size_t s = 0; s < enclosure.sphere_count(); ++s)
    state.relaxation[s] = relaxation[static_cast<std::size_t>(enclosure.particle[s])];
}

void HeatModel::radiate(Bed& bed, double interval_s) {
  interval_s_ = interval_s;
  const Enclosure enclosure = make_enclosure(bed, case_.flow.region);
  auto [state, conducted] = look_ahead(bed, enclosure);
  const auto update = static_cast<std::uint64_t>(radiation_.updates);
  if (case_.heat.radiation.error > 0) state.wanted_error_W = wanted_error_W(enclosure, state, update);
  RadiativeHeat heat = draw_heats(enclosure, state, update);
  if (state.implicit) {
    const double moved = keep_within_bounds(bed, conducted, enclosure, state, interval_s_, heat);
    radiation_.limited_share = std::max(radiation_.limited_share, moved);
  }
  bed.radiative_heat_W = by_particle(bed, enclosure, heat).heat_W;
  walls_.hold_radiation(enclosure, heat.heat_W);
  radiation_.updates += 1;
  radiation_.rays += heat.rays;
  radiation_.lost_rays += heat.lost_rays;
  radiation_.wall_heat_W = heat.isothermal_wall_heat_W;
  radiation_.missed_W = -sum(heat.heat_W);
  radiation_.error_squared_W2 += heat.isothermal_wall_heat_error_W * heat.isothermal_wall_heat_error_W;
  radiation_.closure_correction = std::max(radiation_.closure_correction, heat.closure_correction);
  radiation_.reciprocity_rms = heat.reciprocity_rms;
  radiation_.absolute_heat_W += std::abs(heat.isothermal_wall_heat_W);
  radiation_.implicit_updates += state.implicit;
}

/// So that the mean wall heat over all updates of the run has the error asked for, relative to the mean so far; at the
/// first update relative to a first look.
double HeatModel::wanted_error_W(const Enclosure& enclosure, const RadiativeState& state,
                                 std::uint64_t update) {
  double mean_W =
      radiation_.absolute_heat_W / static_cast<double>(std::max<std::int64_t>(1, radiation_.updates));
  if (radiation_.updates == 0) mean_W = std::abs(draw_heats(enclosure, state, update).isothermal_wall_heat_W);
  const double updates = std::max(1.0, case_.flow.end_time_s / interval_s_);
  return case_.heat.radiation.error * mean_W * std::sqrt(updates);
}

void HeatModel::advance(Bed& bed, double dt_s) {
  std::vector<HeatPaths> from_walls_J;
  ledger_.receive(advance_in_parts(bed, conductances_, dt_s, from_walls_J));
  walls_.add(from_walls_J, dt_s);
  ledger_.miss(radiation_.missed_W * dt_s);
}

StateBlock HeatModel::save() const {
  StateBlock block;
  save_values(radiation_, block);
  return block;
}

void HeatModel::load(const StateBlock& radiation, const StateBlock& ledger) {
  restore_values(radiation_, radiation);
  ledger_.load(ledger);
}

std::vector<char> in_region(const Bed& bed, const Box& region) {
  std::vector<char> inside(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i)
    inside[i] = region.contains(wrapped_into_box(bed, bed.position_m[i]));
  return inside;
}

}  // namespace granrad
