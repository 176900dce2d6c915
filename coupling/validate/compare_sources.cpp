#include "coupling/validate/compare_sources.h"

#include <fmt/core.h>

#include <cmath>

#include "coupling/simulation/simulation.h"
#include "coupling/validate/update_cost.h"
#include "dem/base/constants.h"

namespace granrad {

namespace {

constexpr std::uint64_t first_draw = 1ULL << 40;  // random numbers no update of the run uses

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value * value;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Mean of several draws where draws differ, with its noise.
SourceInstant observe(Simulation& simulation, const Case& c, int draws) {
  const Bed& bed = simulation.bed();
  std::vector<double> heat(bed.size(), 0.0), variance(bed.size(), 0.0);
  for (int k = 0; k < draws; ++k) {
    const auto drawn = simulation.draw_radiation(first_draw + k);
    for (std::size_t i = 0; i < bed.size(); ++i) {
      heat[i] += drawn.heat_W[i] / draws;
      if (!drawn.standard_error_W.empty())
        variance[i] += drawn.standard_error_W[i] * drawn.standard_error_W[i] / (draws * draws);
    }
  }
  SourceInstant instant;
  instant.time_s = bed.time_s;
  const auto inside = in_region(bed, c.flow.region);
  std::vector<double> noise;
  double heat_sum = 0, area_sum = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!inside[i]) continue;
    const double area = 4 * pi * bed.radius_m[i] * bed.radius_m[i];
    instant.id.push_back(bed.id[i]);
    instant.position_m.push_back(bed.position_m[i]);
    instant.temperature_K.push_back(bed.temperature_K[i]);
    instant.flux_W_m2.push_back(heat[i] / area);
    noise.push_back(std::sqrt(variance[i]) / area);
    heat_sum += heat[i];
    area_sum += area;
  }
  instant.mean_temperature_K = mean(instant.temperature_K);
  instant.mean_flux_W_m2 = area_sum > 0 ? heat_sum / area_sum : 0;
  instant.flux_noise_W_m2 = rms(noise);
  instant.energy_defect = simulation.heat().ledger().relative_defect(bed, 0, 0);
  instant.reciprocity_rms = simulation.heat().radiation().reciprocity_rms;
  return instant;
}

}  // namespace

SourceTrack heat_frozen_bed(const Case& c, const Bed& bed, const RadiationSettings& radiation,
                            const std::vector<double>& times_s, int draws, int threads,
                            const std::function<void(double)>& progress) {
  Case frozen = c;
  frozen.flow.engine = EngineKind::none;
  frozen.flow.end_time_s = times_s.back();
  const double every_s = radiation_interval_s(c, step_limits(c, bed));
  frozen.heat.radiation = radiation;
  frozen.heat.radiation.every_s = every_s;
  frozen.heat.output = {every_s, every_s};
  Simulation simulation(frozen, threads);
  simulation.start(bed);

  SourceTrack track;
  track.label = source_label(radiation);
  Case moving = frozen;  // black surfaces on lines need no matrix there
  moving.flow.engine = EngineKind::native;
  track.seconds_per_update = update_cost(moving, bed, threads).cpu_s;
  track.rays = radiation.kind == RadiationKind::correlation && !radiation.traced_walls ? 0 : radiation.rays;
  const double steps = std::ceil(times_s.back() / every_s * (1 - 1e-9)),
               draws_each = radiation.kind == RadiationKind::paths ? draws : 1,
               work = steps + draws_each * static_cast<double>(times_s.size());
  double done = 0;
  progress(0);
  for (double time : times_s) {
    while (simulation.bed().time_s < time * (1 - 1e-9) && !simulation.finished()) {
      simulation.advance();
      track.curve_time_s.push_back(simulation.bed().time_s);
      track.curve_temperature_K.push_back(
          mean_temperature_K(simulation.bed(), in_region(simulation.bed(), frozen.flow.region)));
      progress(++done / work);
    }
    track.at.push_back(observe(simulation, frozen, static_cast<int>(draws_each)));
    done += draws_each;
    progress(done / work);
  }
  return track;
}

SourceComparison compare(const SourceInstant& source, const SourceInstant& reference) {
  const double flux = std::abs(reference.mean_flux_W_m2), unit = 100 / flux;
  const double n = static_cast<double>(source.flux_W_m2.size());
  double square = 0, fourth = 0;
  for (std::size_t i = 0; i < source.flux_W_m2.size(); ++i) {
    const double d2 = std::pow(source.flux_W_m2[i] - reference.flux_W_m2[i], 2);
    square += d2 / n, fourth += d2 * d2 / n;
  }
  const bool itself = &source == &reference;
  const double theirs = itself ? 0 : std::pow(reference.flux_noise_W_m2, 2),
               own = std::pow(source.flux_noise_W_m2, 2);
  SourceComparison c{};
  c.temperature_error_pct = 100 * (source.mean_temperature_K / reference.mean_temperature_K - 1);
  c.flux_error_pct = 100 * (source.mean_flux_W_m2 / reference.mean_flux_W_m2 - 1);
  c.particle_flux_rms_pct = unit * std::sqrt(square);
  c.reference_noise_pct = unit * reference.flux_noise_W_m2;
  c.source_noise_pct = unit * source.flux_noise_W_m2;
  if (square > 0)
    c.rms_error_pct = unit * 0.5 * std::sqrt(std::max(0.0, fourth - square * square) / n / square);
  c.flux_noise_pct = itself ? 0 : unit * std::sqrt((theirs + own) / n);
  c.own_rms_pct = unit * std::sqrt(std::max(0.0, square - theirs));
  c.bias_pct = unit * std::sqrt(std::max(0.0, square - theirs - own));
  return c;
}

double seconds_to_reach(double goal_pct, const SourceComparison& with, double seconds_per_update) {
  const double room2 = goal_pct * goal_pct - with.bias_pct * with.bias_pct;
  if (!(room2 > 0)) return std::nan("");
  return seconds_per_update * std::max(1.0, with.source_noise_pct * with.source_noise_pct / room2);
}

double seconds_until_noise(double goal_pct, const SourceComparison& with, double seconds_per_update) {
  return seconds_per_update * std::max(1.0, std::pow(with.source_noise_pct / goal_pct, 2));
}

std::string source_label(const RadiationSettings& settings) {
  std::string label = to_string(settings.kind);
  if (settings.order > 0) label += fmt::format(" order {}", settings.order);
  if (settings.kind == RadiationKind::correlation)
    label = fmt::format("{} {}{}", label, settings.table.stem().string(),
                        settings.traced_walls ? ", traced walls" : "");
  if (settings.closure == Closure::row_sum) label += " row_sum";
  return label;
}

}  // namespace granrad
