#include "coupling/forecast/forecast.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/forecast/flow_speed.h"
#include "coupling/simulation/heat_model.h"
#include "coupling/validate/update_cost.h"
#include "dem/base/clock.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr double trial_s = 0.5;                 // for flow and conduction
constexpr double usual_particle_steps_s = 1e7;  // whether a trial is short
constexpr double rays_of_a_trial = 4e6, walks_of_a_trial = 1e6;
constexpr std::size_t most_particles_tried = 20000;
constexpr double poured_to_resting =
    0.45;  // speed of the flow: lists made anew, walls of hoppers; of two moving beds
constexpr double bytes_per_particle = 700;  // columns, lists, contacts and conductances of a dense bed
constexpr double frame_bytes_per_particle = 330;
constexpr double frame_s = 0.002, disk_bytes_s = 2e8, row_s = 3e-4;  // of an SSD

/// Without the longest tenth, in which other programs had their turn.
double undisturbed_mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.resize(values.size() - values.size() / 10);
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Mean number of particles over the run, of those there are now.
double mean_count(const Case& c, const Bed& bed) {
  const FeedSettings& feed = c.flow.feed;
  const double now = static_cast<double>(bed.size());
  if (feed.rate_1_s > 0) {
    const double most = static_cast<double>(feed.particle_count) - now,
                 comes = feed.rate_1_s * c.flow.end_time_s;
    return now + (comes <= most ? comes / 2 : most * (1 - most / (2 * comes)));
  }
  if (feed.kind == FeedSettings::Kind::hopper)
    return std::max(now, feed.refill ? static_cast<double>(feed.particle_count) : now);
  if (feed.kind == FeedSettings::Kind::plug && now == 0)
    return feed.solid_fraction * c.flow.box.volume() / sphere_volume(c.flow.particle_diameter_m / 2);
  return now;
}

Case with_rays(const Case& c, double rays) {
  Case trial = c;
  trial.heat.radiation.rays = rays;
  return trial;
}

/// Rays (walks) that one trial may take, of those the case asks for.
double rays_to_try(const Case& c, const Bed& bed) {
  const bool paths = c.heat.radiation.kind == RadiationKind::paths;
  const double most =
      paths ? walks_of_a_trial : std::max(20.0, rays_of_a_trial / static_cast<double>(bed.size()));
  return std::min(c.heat.radiation.rays, most);
}

/// Seconds of one radiation update: in all, and of that what its rays do not change.
struct UpdateSeconds {
  double all = 0, repeated = 0;
};

/// View factors made anew: a fixed part and one in proportion to the rays, from two trials.
UpdateSeconds seconds_of_an_update(const Case& c, const Bed& bed, int threads) {
  const RadiationSettings& radiation = c.heat.radiation;
  if (radiation.kind == RadiationKind::none || bed.size() == 0) return {};
  const double many = rays_to_try(c, bed), with_many = update_cost(with_rays(c, many), bed, threads).wall_s;
  if (radiation.rays <= 0) return {with_many, with_many};
  const bool paths = radiation.kind == RadiationKind::paths;
  const bool shared = paths || radiation.kind == RadiationKind::embree ||
                      (radiation.kind == RadiationKind::lines && radiation.order == 0);
  const double few = many / 3;  // not fewer: rows must close
  const double fewest = paths ? 32 : 5;
  if (few < fewest) return {with_many * radiation.rays / many, shared ? 0 : with_many};
  const double with_few = std::min(with_many, update_cost(with_rays(c, few), bed, threads).wall_s);
  const double per_ray = (with_many - with_few) / (many - few);
  const double all = with_many + per_ray * (radiation.rays - many);
  return {all, shared ? std::max(0.0, with_many - per_ray * many) : all};
}

/// Of the updates of a frozen bed after the first: its view factors are known and radiosities are solved, or its tracer is
/// there and walks are traced.
double seconds_of_a_later_update(const Case& c, const Bed& bed, int threads) {
  const double rays = rays_to_try(c, bed);
  const Case trial = with_rays(c, rays);
  HeatModel heat(trial, threads);
  heat.start(bed);
  heat.draw_radiation(bed, 0);
  const double start = monotonic_s();
  heat.draw_radiation(bed, 0);
  const double walks =
      c.heat.radiation.kind == RadiationKind::paths && rays > 0 ? c.heat.radiation.rays / rays : 1;
  return (monotonic_s() - start) * walks;
}

void foresee_radiation(const Case& c, const Bed& bed, const TimePlan& plan, int threads, Forecast& cost) {
  if (plan.ticks_per_radiation == 0) return;
  const bool moves = c.flow.engine != EngineKind::none, empty = bed.size() == 0;
  const bool walks = c.heat.radiation.kind == RadiationKind::paths;  // ranks share them
  const double updates =
      std::ceil(static_cast<double>(plan.end_tick) / static_cast<double>(plan.ticks_per_radiation));
  cost.radiation_updates = moves || walks ? updates : 1;
  const double times =
      (moves ? updates : 1) * (empty ? 1 : cost.mean_count / static_cast<double>(bed.size()));
  const UpdateSeconds update = seconds_of_an_update(c, bed, threads);
  const double later = moves || empty ? 0 : (updates - 1) * seconds_of_a_later_update(c, bed, threads);
  cost.radiation_s = update.all * times + later;
  cost.radiation_repeated_s = update.repeated * times + (walks ? 0 : later);
}

/// By a trial of the bed at time 0.
void try_flow_and_conduction(const Case& c, const Bed& bed, const TimePlan& plan, int threads,
                             Forecast& cost) {
  Case still = c;
  still.heat.radiation.kind = RadiationKind::none;
  Simulation trial(still, threads);
  trial.start();
  trial.advance();  // lists are made, threads started
  std::vector<double> flow, conduction;
  for (const double start = monotonic_s(); monotonic_s() - start < trial_s && !trial.finished();) {
    const PartSeconds before = trial.seconds();
    trial.advance();
    flow.push_back(trial.seconds().flow - before.flow);
    conduction.push_back(trial.seconds().conduction - before.conduction);
  }
  if (flow.empty()) flow.push_back(trial.seconds().flow), conduction.push_back(trial.seconds().conduction);
  const double more = cost.heat_steps * cost.mean_count / static_cast<double>(bed.size());
  cost.flow_s = undisturbed_mean(flow) * more * plan.tick_s / trial.plan().tick_s;
  cost.conduction_s = undisturbed_mean(conduction) * more;
}

/// Where the bed of time 0 has no contacts yet, is empty or too large to try.
void foresee_flow_in_contact(const Case& c, const TimePlan& plan, int threads, Forecast& cost) {
  const bool moves = c.flow.engine != EngineKind::none;
  const bool poured = c.flow.feed.kind == FeedSettings::Kind::hopper && norm(c.flow.gravity_m_s2) > 0;
  if (!poured && (cost.flow_s > 0 || !moves)) return;
  const double speed =
      speed_in_contact(c.flow, plan.step_s, cost.mean_count, threads) * (poured ? poured_to_resting : 1);
  const double steps = cost.heat_steps * static_cast<double>(plan.steps_per_tick);
  const double flow_s = speed > 0 ? cost.mean_count * steps / speed : 0;
  if (flow_s > cost.flow_s) cost.flow_s = flow_s, cost.speed_in_contact = speed;
}

}  // namespace

Forecast forecast(const Case& c, Simulation& simulation, int threads) {
  Forecast cost;
  const TimePlan& plan = simulation.plan();
  const Bed& bed = simulation.bed();
  cost.heat_steps = static_cast<double>(plan.end_tick), cost.mean_count = mean_count(c, bed);
  cost.threads = threads > 0 ? threads : omp_get_max_threads();
  foresee_radiation(c, bed, plan, threads, cost);
  const bool moves = c.flow.engine != EngineKind::none;
  const double expected_tick_s = static_cast<double>(bed.size()) *
                                 static_cast<double>(moves ? plan.steps_per_tick : 1) /
                                 usual_particle_steps_s;
  if (bed.size() > 0 && expected_tick_s < 2 * trial_s) try_flow_and_conduction(c, bed, plan, threads, cost);
  foresee_flow_in_contact(c, plan, threads, cost);
  cost.frames = std::ceil(cost.heat_steps / static_cast<double>(plan.ticks_per_frame)) + 1;
  cost.frame_bytes = 6e4 + frame_bytes_per_particle * cost.mean_count;
  cost.output_s = cost.frames * (frame_s + cost.frame_bytes / disk_bytes_s) +
                  row_s * cost.heat_steps / static_cast<double>(plan.ticks_per_row);
  cost.memory_bytes = 6e7 + bytes_per_particle * cost.mean_count;
  return cost;
}

std::vector<SourceCost> source_costs(const Case& c, const Bed& bed, int threads) {
  std::vector<SourceCost> costs;
  if (c.heat.radiation.kind == RadiationKind::none || bed.size() == 0 || bed.size() > most_particles_tried)
    return costs;
  const double wanted = c.heat.radiation.error > 0 ? c.heat.radiation.error : 0.01;
  for (const auto& [kind, rays] : {std::pair{RadiationKind::paths, 20000.0},
                                   {RadiationKind::embree, 100.0},
                                   {RadiationKind::lines, 400.0}}) {
    Case trial = c;
    trial.heat.radiation.kind = kind;
    trial.heat.radiation.rays = rays;
    trial.heat.radiation.order = 0;
    try {
      HeatModel heat(trial, threads);
      heat.start(bed);
      const double start = monotonic_s();
      const auto drawn = heat.draw_radiation(bed, 0);
      const double spent = monotonic_s() - start, heat_W = std::abs(drawn.all.isothermal_wall_heat_W),
                   error = drawn.all.isothermal_wall_heat_error_W;
      if (heat_W > 0 && error > 0)
        costs.push_back({to_string(kind), spent * std::pow(error / heat_W / wanted, 2), wanted});
    } catch (const Error&) {  // this source does not serve the bed
    }
  }
  std::sort(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  return costs;
}

}  // namespace granrad
