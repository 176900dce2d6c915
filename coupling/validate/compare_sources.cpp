#include "coupling/validate/compare_sources.h"

#include <fmt/core.h>

#include <cmath>

#include "coupling/simulation/simulation.h"
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
  track.rays = radiation.kind == RadiationKind::correlation && !radiation.traced_walls ? 0 : radiation.rays;
  for (double time : times_s) {
    while (simulation.bed().time_s < time * (1 - 1e-9) && !simulation.finished()) {
      simulation.advance();
      if (simulation.tick() == 1) track.seconds_per_update = simulation.seconds().radiation;
      track.curve_time_s.push_back(simulation.bed().time_s);
      track.curve_temperature_K.push_back(
          mean_temperature_K(simulation.bed(), in_region(simulation.bed(), frozen.flow.region)));
      progress(simulation.bed().time_s);
    }
    track.at.push_back(observe(simulation, frozen, radiation.kind == RadiationKind::paths ? draws : 1));
  }
  return track;
}

SourceComparison compare(const SourceInstant& source, const SourceInstant& reference) {
  const double flux = std::abs(reference.mean_flux_W_m2);
  std::vector<double> difference;
  for (std::size_t i = 0; i < source.flux_W_m2.size(); ++i)
    difference.push_back(source.flux_W_m2[i] - reference.flux_W_m2[i]);
  return {100 * (source.mean_temperature_K / reference.mean_temperature_K - 1),
          100 * (source.mean_flux_W_m2 / reference.mean_flux_W_m2 - 1), 100 * rms(difference) / flux,
          100 * reference.flux_noise_W_m2 / flux};
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
