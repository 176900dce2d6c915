#include "coupling/simulation/radiation_source.h"

#include <fmt/core.h>

#include <algorithm>

#include "coupling/heat/harmonic_source.h"
#include "coupling/heat/radiosity_source.h"
#include "fit/correlation/correlation.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/lines/black_line_source.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/paths/path_source.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {

namespace {

RadiositySource::Estimate embree_estimate(const RadiationSettings& settings, int threads) {
  return [=](const Enclosure& enclosure, std::uint64_t update) {
    TraceOptions options;
    options.rays_per_particle = settings.rays;
    options.seed = settings.seed + update;
    options.threads = threads;
    return one_way_estimate(trace_view_factors(enclosure, options));
  };
}

LineOptions line_options(const RadiationSettings& settings, std::uint64_t update, int threads) {
  LineOptions options = lines_for_rays(settings.rays);
  options.seed = settings.seed + update;
  options.threads = threads;
  return options;
}

RadiositySource::Estimate line_estimate(const RadiationSettings& settings, int threads) {
  return [=](const Enclosure& enclosure, std::uint64_t update) {
    return sweep_exchange_areas(enclosure, line_options(settings, update, threads));
  };
}

std::unique_ptr<ExchangeSource> line_source(const RadiationSettings& settings, const Scene& scene,
                                            int threads) {
  auto areas = std::make_unique<RadiositySource>(line_estimate(settings, threads), settings.closure);
  if (scene.engine == EngineKind::none || settings.closure == Closure::row_sum) return areas;
  return std::make_unique<BlackLineSource>(line_options(settings, 0, threads), std::move(areas));
}

CorrelationUse correlation_use(const RadiationSettings& settings, int threads) {
  CorrelationUse use;
  use.wall_rows = settings.traced_walls ? WallRows::traced : WallRows::table;
  use.wall_rays = settings.rays;
  use.seed = settings.seed;
  use.threads = threads;
  return use;
}

}  // namespace

std::unique_ptr<ExchangeSource> make_radiation_source(const RadiationSettings& settings, const Scene& scene,
                                                      int threads) {
  switch (settings.kind) {
    case RadiationKind::none:
      return nullptr;
    case RadiationKind::paths: {
      PathOptions options;
      options.walks = static_cast<std::int64_t>(settings.rays);
      options.seed = settings.seed;
      options.threads = threads;
      return std::make_unique<PathSource>(options);
    }
    case RadiationKind::embree:
      return std::make_unique<RadiositySource>(embree_estimate(settings, threads), settings.closure);
    case RadiationKind::lines:
      if (settings.order > 0)
        return std::make_unique<HarmonicSource>(settings.order, line_options(settings, 0, threads));
      return line_source(settings, scene, threads);
    case RadiationKind::correlation:
      return std::make_unique<RadiositySource>(
          correlation_exchange(read_correlation(settings.table), correlation_use(settings, threads)),
          settings.closure);
  }
  return nullptr;
}

void check_radiation(const RadiationSettings& settings, const Scene& scene, const Bed& bed) {
  if (settings.kind == RadiationKind::none || bed.size() == 0) return;
  const Enclosure enclosure = make_enclosure(bed, scene.region);
  if (settings.kind == RadiationKind::correlation)
    correlation_exchange_areas(read_correlation(settings.table), enclosure, {});
  if (settings.kind == RadiationKind::lines)
    sweep_exchange_areas(enclosure, {.directions = 1, .lines_per_disc = 1, .replicates = 2});
}

RadiativeState radiative_state(const Bed& bed, const std::vector<double>& temperature_K,
                               const Enclosure& enclosure, double surroundings_K) {
  RadiativeState state;
  for (std::int32_t i : enclosure.particle)
    state.add(temperature_K[i], bed.materials[bed.material[i]].emissivity);
  for (const Wall& wall : enclosure.walls) state.add(wall.temperature_K, wall.emissivity, wall.role);
  state.add(surroundings_K, 1, WallRole::open);
  return state;
}

std::string describe(const RadiationSettings& settings) {
  const char* closure = settings.closure == Closure::row_sum ? "row-sum closure" : "reciprocal closure";
  switch (settings.kind) {
    case RadiationKind::none:
      return "none";
    case RadiationKind::paths:
      return fmt::format("paths, {:.0f} walks per update", settings.rays);
    case RadiationKind::embree:
      return fmt::format("view factors by Embree, {:.0f} rays per particle, {}", settings.rays, closure);
    case RadiationKind::lines:
      if (settings.order > 0)
        return fmt::format(
            "global lines, {:.0f} rays per particle, radiosities of order {} on spheres, in patches on "
            "walls",
            settings.rays, settings.order);
      return fmt::format("view factors by global lines, {:.0f} rays per particle, {}", settings.rays,
                         closure);
    case RadiationKind::correlation:
      return fmt::format(
          "correlation table {}, {}, {}", settings.table.filename().string(),
          settings.traced_walls
              ? fmt::format("rows of the walls traced with {:.0f} rays per particle", settings.rays)
              : "walls from the table",
          closure);
  }
  return "";
}

}  // namespace granrad
