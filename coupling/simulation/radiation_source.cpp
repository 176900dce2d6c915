#include "coupling/simulation/radiation_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/heat/harmonic_source.h"
#include "coupling/heat/radiosity_source.h"
#include "dem/base/error.h"
#include "fit/correlation/correlation.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/lines/black_line_source.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/mesh_check.h"
#include "raytrace/paths/path_source.h"
#include "raytrace/rays/enclosure_check.h"
#include "raytrace/rays/view_factors.h"
#include "raytrace/shading/shading_exchange.h"

namespace granrad {

namespace {

/// Probe rays that leave through closed walls: the rounding of edges.
constexpr std::int64_t few_open = 2;
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

std::optional<double> known_surroundings_K(const Scene& scene, std::optional<double> stated_K) {
  if (stated_K) return stated_K;
  std::optional<double> found;
  for (const Wall& wall : scene.walls) {
    if (wall.role != WallRole::open) continue;
    if (found && *found != wall.temperature_K) return {};
    found = wall.temperature_K;
  }
  return found;
}

namespace {

/// Where rays leave, now or when a shutter has opened.
std::string opening_problem(const Scene& scene, const Bed& bed, const EnclosureCheck& now) {
  const auto said = [](const EnclosureCheck& check, const char* when) {
    return advised(
        fmt::format("the walls do not close{}: {} of {} probe rays leave, most from {}, and nothing "
                    "says how warm it is out there",
                    when, check.open, check.rays, check.leaves_most),
        "give [surroundings] temperature_K, or close the walls");
  };
  if (now.open > few_open) return said(now, "");
  double last_s = -infinity;  // walls that never open have opens_at_s = infinity
  for (const Wall& wall : scene.walls)
    if (std::isfinite(wall.opens_at_s)) last_s = std::max(last_s, wall.opens_at_s);
  if (!(last_s > bed.time_s)) return "";
  Bed opened = bed;
  opened.time_s = last_s;
  const EnclosureCheck then = check_enclosure(make_enclosure(opened, scene.region), bed.id);
  return then.open > few_open ? said(then, " once the shutters are open") : "";
}

bool reflects(const Wall& wall) {
  return wall.role == WallRole::adiabatic || (wall.role == WallRole::isothermal && wall.emissivity < 1);
}

/// Walls that reflect and would be cut into patches, but cannot: not those the scene asks to be whole.
std::string whole_walls_note(const RadiationSettings& settings, const Enclosure& enclosure) {
  if (!settings.patches || settings.closure != Closure::reciprocal || settings.kind == RadiationKind::paths)
    return "";
  const bool periodic = enclosure.periodic != std::array<bool, 3>{};
  std::vector<char> cut;
  for (const Wall& wall : enclosure.walls) cut.push_back(reflects(wall) && !periodic);
  const WallPatches patches(enclosure.walls, infinity, cut);
  std::string names;
  for (std::size_t w = 0; w < cut.size(); ++w)
    if (reflects(enclosure.walls[w]) && !patches.is_cut(static_cast<std::int32_t>(w)))
      names += (names.empty() ? "" : ", ") + enclosure.walls[w].name;
  if (names.empty()) return "";
  return advised(fmt::format("one radiosity for all of each wall that reflects, {}: {}", names,
                             periodic ? "walls of periodic boxes are not cut into patches"
                                      : "meshes of more than 1000 flat faces are not cut into patches"),
                 "where light falls on them unevenly, source = paths has no such error");
}

/// Sources of one radiosity for each wall: light that falls on one side of a sheet would leave from the other.
std::vector<std::string> sheets_that_join_their_sides(const Enclosure& enclosure) {
  std::vector<std::string> problems;
  for (const Wall& wall : enclosure.walls) {
    if (reflects(wall) && has_two_sides(wall))
      problems.push_back(advised(
          fmt::format(
              "wall {} has two sides and reflects (with one radiosity for both, what falls on the one "
              "would leave from the other)",
              wall.name),
          "use source = paths, or a wall for each side"));
  }
  return problems;
}

}  // namespace

std::vector<std::string> check_radiation(const RadiationSettings& settings, const Scene& scene,
                                         const Bed& bed, std::optional<double> surroundings_K) {
  if (settings.kind == RadiationKind::none) return {};
  const Enclosure enclosure = make_enclosure(bed, scene.region);
  EnclosureCheck check = check_enclosure(enclosure, bed.id);
  if (auto note = whole_walls_note(settings, enclosure); !note.empty())
    check.notes.push_back(std::move(note));
  std::vector<std::string> problems = check.problems;
  if (!known_surroundings_K(scene, surroundings_K))
    if (const auto problem = opening_problem(scene, bed, check); !problem.empty())
      problems.push_back(problem);
  if (settings.kind == RadiationKind::embree || settings.kind == RadiationKind::shading)
    for (auto& problem : sheets_that_join_their_sides(enclosure)) problems.push_back(std::move(problem));
  if (!problems.empty()) throw InputError(problems);
  if (bed.size() == 0) return check.notes;
  if (settings.kind == RadiationKind::correlation)
    correlation_exchange_areas(read_correlation(settings.table), enclosure, {});
  if (settings.kind == RadiationKind::shading) refuse_what_shading_cannot_serve(enclosure, settings.rays);
  if (settings.kind == RadiationKind::lines) {
    const LineOptions options = line_options(settings, 0, 1);
    refuse_wasted_lines(LineScene(enclosure, options.lines_per_disc), options, options.directions);
    sweep_exchange_areas(enclosure, {.directions = 1, .lines_per_disc = 1, .replicates = 2});
  }
  return check.notes;
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
