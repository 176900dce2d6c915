#include "coupling/simulation/radiation_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/heat/harmonic_source.h"
#include "coupling/heat/radiosity_source.h"
#include "coupling/simulation/radiation_check.h"
#include "dem/base/error.h"
#include "fit/correlation/correlation.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/lines/black_line_source.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/paths/path_source.h"
#include "raytrace/rays/enclosure_check.h"
#include "raytrace/rays/view_factors.h"
#include "raytrace/shading/shading_exchange.h"

namespace granrad {

namespace {

constexpr double default_radiation_interval_s = 0.01;
constexpr double default_heat_error = 0.01;
constexpr double default_walks = 10000;  // paths, per update: 1 % noise in the wall heat needs about 1300
constexpr double default_rays_per_particle = 2000;
constexpr double default_line_ends_per_particle = 24000;  // 250 directions; lines are far cheaper than rays

constexpr double default_rays_of_walls = 300;  // correlation with traced walls: of the walls, per particle
constexpr double default_wall_rays_per_particle = 200;  // shading: sent by the walls
constexpr double default_line_ends_for_moments = 4800;  // 100 directions in each replicate

double default_rays(RadiationKind kind, int order) {
  if (kind == RadiationKind::paths) return default_walks;
  if (kind == RadiationKind::correlation) return default_rays_of_walls;
  if (order > 0) return default_line_ends_for_moments;
  if (kind == RadiationKind::shading) return default_wall_rays_per_particle;
  return kind == RadiationKind::lines ? default_line_ends_per_particle : default_rays_per_particle;
}

/// Rays, or the error to choose them by.
void read_effort(TomlTable& table, RadiationSettings& settings) {
  const bool paths = settings.kind == RadiationKind::paths;
  const auto rays = table.number_or_auto(
      {"rays",
       "walks per update (paths; auto: as many as error needs), rays or line ends per particle (others)",
       "10000 (paths), 2000 (embree), 200 (shading, from the walls), 24000 (lines), 4800 (lines of order 1 to 3), 300 (traced wall rows)"},
      {.min = paths ? 2.0 * path_batches : 1,
       .max = 1e9,
       .why = paths ? "walks per update" : "rays per particle"},
      default_rays(settings.kind, settings.order), paths && table.has("error"));
  settings.rays = rays.value_or(0);
  const auto error = table.optional_number(
      {"error",
       "paths: relative standard error of the mean wall heat over the run, that rays = auto aims at"},
      {.min = 1e-5, .max = 0.5, .why = "relative standard error"});
  if (!rays) settings.error = error.value_or(default_heat_error);
  if (!paths && !rays) table.problem("rays", "= \"auto\" is for source = paths; give a number");
  if (error && rays && table.has("error"))
    table.problem("error", "is used with source = paths and rays = \"auto\" only; leave one of them out");
}

}  // namespace

RadiationSettings read_source(TomlTable table, const Scene& scene, RadiationKind otherwise) {
  RadiationSettings settings;
  settings.kind = table.choice(
      {"source",
       "paths: traced in the loop, exact; embree, lines, shading: view factors and radiosity; correlation: view factors from a table",
       "paths; none without [radiation]"},
      radiation_names, otherwise);
  settings.table = table.file({"table", "correlation table, for source = correlation"},
                              settings.kind == RadiationKind::correlation);
  settings.traced_walls =
      table.choice(
          {"wall_rows", "of a correlation: exchange of the walls from the table, or by rays from the walls"},
          {"table", "traced"}, "table") == "traced";
  settings.order = static_cast<int>(table.integer(
      {"order", "of the radiosity over each sphere, with lines: 0 uniform, 1 to 3 spherical harmonics"}, 0, 3,
      0));
  read_effort(table, settings);
  settings.closure =
      table.choice(
          {"closure",
           "how view factors are made to sum to one: reciprocal keeps A_i F_ij = A_j F_ji as well; row_sum is the paper's"},
          {"reciprocal", "row_sum"}, "reciprocal") == "row_sum"
          ? Closure::row_sum
          : Closure::reciprocal;
  settings.patches =
      table.choice(
          {"wall_patches",
           "of adiabatic and grey walls (polygons and flat faces of meshes), with embree, lines, shading and traced wall rows: auto cuts them into patches with a radiosity each, whole gives each wall one"},
          {"auto", "whole"}, "auto") == "auto";
  settings.seed = static_cast<std::uint64_t>(table.integer({"seed", "of the rays"}, 0, 1LL << 62, 1));

  check_source(table, settings, scene);
  return settings;
}

RadiationSettings read_radiation(TomlTable table, const Scene& scene) {
  RadiationSettings settings =
      read_source(table, scene, table.present() ? RadiationKind::paths : RadiationKind::none);
  const Key every{"every_s",
                  "time between updates of the radiation; auto: by motion and the radiative time constant"};
  const NumberRule positive{.unit = "s", .min = 0, .min_exclusive = true};
  settings.every_s = table.number_or_auto(every, positive, default_radiation_interval_s).value_or(0);
  return settings;
}

namespace {

/// Independent sets of rays of an update: enough to know the error of the wall heat to a quarter.
constexpr int wall_heat_replicates = 8;
/// Share of the rays that may meet the back of a wall: rounding at edges. Each such ray is counted (lost_rays).
constexpr double most_leaks = 1e-3;

/// View factors with walls in patches, or whole where that is asked for or replicates the paper.
std::unique_ptr<RadiositySource> radiosity_source(const RadiationSettings& settings,
                                                  RadiositySource::PatchEstimate estimate) {
  if (settings.patches && settings.closure == Closure::reciprocal)
    return std::make_unique<RadiositySource>(std::move(estimate), settings.closure);
  const auto whole = [e = std::move(estimate)](const Enclosure& enclosure, std::uint64_t key) {
    return e(enclosure, WallPatches(enclosure.walls, 0, std::vector<char>(enclosure.walls.size(), 0)), key);
  };
  return std::make_unique<RadiositySource>(RadiositySource::Estimate(whole), settings.closure);
}

/// Before closure, which would share a defect out among the others.
void require_sound(const Enclosure& enclosure, const HitCounts& counts) {
  const auto rays = std::accumulate(counts.launched.begin(), counts.launched.end(), std::int64_t{0});
  const bool without_end = enclosure.walls.empty();  // no back to meet
  if (static_cast<double>(counts.leaked) > most_leaks * static_cast<double>(rays) && without_end)
    throw NumericalError(
        advised(fmt::format("radiation: {} of {} rays met nothing in 10^4 periods and mean free paths",
                            counts.leaked, rays),
                "the bed is too thin for a periodic box: make the box smaller, or close it with walls"));
  if (static_cast<double>(counts.leaked) > most_leaks * static_cast<double>(rays))
    throw NumericalError(advised(
        fmt::format("radiation: {} of {} rays met the back of a wall", counts.leaked, rays),
        "turn its normals to the particles (flip = true) or let both sides radiate (two_sided = true)"));
  if (const SelfCheck check = self_check(enclosure, counts, most_leaks); !check.failed.empty())
    throw NumericalError(advised("radiation: the view factors are not sound: " + check.failed,
                                 "look for bodies that reach into each other, or take source = paths"));
}

RadiositySource::PatchEstimate embree_estimate(const RadiationSettings& settings, int threads) {
  return [=](const Enclosure& enclosure, const WallPatches& patches, std::uint64_t update) {
    TraceOptions options;
    options.rays_per_particle = settings.rays;
    options.seed = settings.seed + update;
    options.threads = threads;
    options.kept_replicates = wall_heat_replicates;
    const HitCounts counts = trace_view_factors(enclosure, options, nullptr, &patches);
    require_sound(patches.applied_to(enclosure), counts);
    return ExchangeEstimate(one_way_estimate(counts), replicate_samples(counts), counts.leaked);
  };
}

LineOptions line_options(const RadiationSettings& settings, std::uint64_t update, int threads) {
  LineOptions options = lines_for_rays(settings.rays);
  options.seed = settings.seed + update;
  options.threads = threads;
  return options;
}

RadiositySource::PatchEstimate shading_estimate(const RadiationSettings& settings, int threads) {
  return [=](const Enclosure& enclosure, const WallPatches& patches, std::uint64_t update) {
    return shading_exchange_areas(enclosure, {settings.rays, settings.seed + update, threads, &patches});
  };
}

RadiositySource::PatchEstimate line_estimate(const RadiationSettings& settings, int threads) {
  return [=](const Enclosure& enclosure, const WallPatches& patches, std::uint64_t update) {
    ReplicateSamples replicates;
    ExchangeAreas areas = sweep_exchange_areas(enclosure, line_options(settings, update, threads), nullptr,
                                               &replicates, &patches);
    return ExchangeEstimate(std::move(areas), std::move(replicates));
  };
}

std::unique_ptr<ExchangeSource> line_source(const RadiationSettings& settings, const Scene& scene,
                                            int threads) {
  auto areas = radiosity_source(settings, line_estimate(settings, threads));
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

RadiositySource::PatchEstimate correlation_estimate(const RadiationSettings& settings, int threads) {
  return [table = read_correlation(settings.table), use = correlation_use(settings, threads)](
             const Enclosure& enclosure, const WallPatches& patches, std::uint64_t update) {
    CorrelationUse of_patches = use;
    of_patches.patches = &patches;
    return correlation_exchange_areas(table, enclosure, of_patches, update);
  };
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
      return radiosity_source(settings, embree_estimate(settings, threads));
    case RadiationKind::lines:
      if (settings.order > 0)
        return std::make_unique<HarmonicSource>(settings.order, line_options(settings, 0, threads));
      return line_source(settings, scene, threads);
    case RadiationKind::shading:
      return radiosity_source(settings, shading_estimate(settings, threads));
    case RadiationKind::correlation:
      if (settings.traced_walls) return radiosity_source(settings, correlation_estimate(settings, threads));
      return std::make_unique<RadiositySource>(
          RadiositySource::Estimate(
              correlation_exchange(read_correlation(settings.table), correlation_use(settings, threads))),
          settings.closure);
  }
  return nullptr;
}

RadiativeState radiative_state(const Bed& bed, const std::vector<double>& temperature_K,
                               const Enclosure& enclosure, double surroundings_K) {
  RadiativeState state;
  for (std::size_t k = 0; k < enclosure.sphere_count(); ++k)
    state.add(temperature_K[enclosure.particle[k]], bed.materials[enclosure.material[k]].emissivity);
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
      if (settings.rays == 0)
        return fmt::format("paths, walks chosen for {:g} % error of the mean wall heat",
                           100 * settings.error);
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
    case RadiationKind::shading:
      return fmt::format("explicit shading of pairs, walls by {:.0f} rays per particle, {}", settings.rays,
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
