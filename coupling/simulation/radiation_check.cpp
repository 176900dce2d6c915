#include "coupling/simulation/radiation_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/correlation.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/mesh_check.h"
#include "raytrace/rays/enclosure_check.h"
#include "raytrace/shading/shading_exchange.h"
#include "raytrace/wall_patches.h"

namespace granrad {

namespace {

/// Probe rays that leave through closed walls: the rounding of edges.
constexpr std::int64_t few_open = 2;

void check_source_against_walls(TomlTable& table, RadiationKind kind, const Scene& scene) {
  const std::string name = to_string(kind);
  const bool needs_planes = kind == RadiationKind::lines || kind == RadiationKind::correlation;
  if ((kind == RadiationKind::correlation || kind == RadiationKind::shading) &&
      (scene.periodic[0] || scene.periodic[1] || scene.periodic[2]))
    table.problem("source",
                  fmt::format("= {} (the box is periodic: this source needs walls all around); choose paths, "
                              "embree or lines",
                              name));
  for (const Wall& wall : scene.walls) {
    if (wall.role == WallRole::excluded && kind == RadiationKind::paths)
      table.problem("source",
                    fmt::format("= {} (wall {} is excluded: only view factors can drop a wall before "
                                "closure); make it adiabatic, or choose embree, lines or correlation",
                                name, wall.name));
    if (needs_planes && !plane_of(wall))
      table.problem(
          "source",
          fmt::format("= {} (wall {} is not in one plane: this source knows planar walls only); choose "
                      "paths or embree",
                      name, wall.name));
  }
}

void check_order(TomlTable& table, RadiationKind kind, const Scene& scene) {
  if (kind != RadiationKind::lines)
    table.problem("order", fmt::format("is not used by source = {}; leave it out or set source = \"lines\"",
                                       to_string(kind)));
  if (scene.periodic[0] || scene.periodic[1] || scene.periodic[2])
    table.problem("order", "must be 0 (the box is periodic); source = \"paths\" is exact there");
  for (const Wall& wall : scene.walls)
    if (wall.role == WallRole::excluded)
      table.problem("order", fmt::format("must be 0 (wall {} is excluded); make it adiabatic", wall.name));
  if (table.has("wall_patches"))
    table.problem("wall_patches",
                  "is not used with order > 0 (all walls are in patches there); leave it out");
  if (table.has("closure"))
    table.problem("closure",
                  "nothing is closed with order > 0 (its moments close by themselves); leave it out");
}

/// A plug states its solid fraction, and a bed that is poured settles near random close packing; of other beds
/// it is measured when they exist.
void check_table(TomlTable& table, const std::filesystem::path& file, const Scene& scene) {
  if (!std::filesystem::is_regular_file(file)) return;  // reported by the reader
  try {
    const auto correlation = read_correlation(file);
    constexpr double poured = 0.53;  // the loosest that random packings of equal spheres settle to
    if (scene.feed.kind == FeedSettings::Kind::plug)
      require_solid_fraction(correlation, scene.feed.solid_fraction, "the plug");
    if (scene.feed.kind == FeedSettings::Kind::hopper && norm(scene.gravity_m_s2) > 0)
      require_solid_fraction(correlation, poured, "a bed poured under gravity, at least,");
  } catch (const InputError& error) {
    table.problem("table", fmt::format("= {} ({})", file.string(), error.what()));
  }
}

}  // namespace

void check_source(TomlTable& table, const RadiationSettings& settings, const Scene& scene) {
  const bool paths = settings.kind == RadiationKind::paths;
  if (table.has("table") && settings.kind != RadiationKind::correlation)
    table.problem("table",
                  fmt::format("is not used by source = {}; leave it out or set source = \"correlation\"",
                              to_string(settings.kind)));
  if (table.has("wall_rows") && settings.kind != RadiationKind::correlation)
    table.problem("wall_rows",
                  fmt::format("is not used by source = {}; leave it out or set source = \"correlation\"",
                              to_string(settings.kind)));
  const bool table_walls = settings.kind == RadiationKind::correlation && !settings.traced_walls;
  if (table.has("wall_patches") && (paths || settings.kind == RadiationKind::none || table_walls))
    table.problem("wall_patches",
                  fmt::format("is not used by source = {}{}; leave it out", to_string(settings.kind),
                              table_walls ? " without wall_rows = \"traced\"" : ""));
  if (table.has("wall_patches") && settings.closure == Closure::row_sum)
    table.problem("wall_patches", "is not used with closure = \"row_sum\", the paper's; leave it out");
  if (settings.order > 0) check_order(table, settings.kind, scene);
  if (table.has("closure") && (paths || settings.kind == RadiationKind::none))
    table.problem("closure",
                  fmt::format("nothing is closed with source = {}; leave it out", to_string(settings.kind)));
  if (settings.kind == RadiationKind::correlation) check_table(table, settings.table, scene);
  if (settings.kind != RadiationKind::none) check_source_against_walls(table, settings.kind, scene);
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

/// Whether each wall has a radiosity for each patch of each of its faces.
std::vector<char> cut_walls(const RadiationSettings& settings, const Enclosure& enclosure) {
  std::vector<char> cut(enclosure.walls.size(), 0);
  const bool periodic = enclosure.periodic != std::array<bool, 3>{};
  if (!settings.patches || settings.closure != Closure::reciprocal || periodic) return cut;
  for (std::size_t w = 0; w < cut.size(); ++w) cut[w] = reflects(enclosure.walls[w]);
  const WallPatches patches(enclosure.walls, infinity, cut);
  for (std::size_t w = 0; w < cut.size(); ++w) cut[w] = patches.is_cut(static_cast<std::int32_t>(w));
  return cut;
}

/// Walls that reflect and would be cut into patches, but cannot: not those the scene asks to be whole.
std::string whole_walls_note(const RadiationSettings& settings, const Enclosure& enclosure,
                             const std::vector<char>& cut) {
  if (!settings.patches || settings.closure != Closure::reciprocal || settings.kind == RadiationKind::paths)
    return "";
  std::string names;
  for (std::size_t w = 0; w < cut.size(); ++w)
    if (reflects(enclosure.walls[w]) && !cut[w])
      names += (names.empty() ? "" : ", ") + enclosure.walls[w].name;
  if (names.empty()) return "";
  const bool periodic = enclosure.periodic != std::array<bool, 3>{};
  return advised(fmt::format("one radiosity for all of each wall that reflects, {}: {}", names,
                             periodic ? "walls of periodic boxes are not cut into patches"
                                      : "meshes of more than 1000 flat faces are not cut into patches"),
                 "where light falls on them unevenly, source = paths has no such error");
}

/// Walls of one radiosity: light that falls on one side of a sheet would leave from the other.
std::vector<std::string> sheets_that_join_their_sides(const Enclosure& enclosure,
                                                      const std::vector<char>& cut) {
  std::vector<std::string> problems;
  for (std::size_t w = 0; w < cut.size(); ++w) {
    const Wall& wall = enclosure.walls[w];
    if (reflects(wall) && !cut[w] && has_two_sides(wall))
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
  const std::vector<char> cut = cut_walls(settings, enclosure);
  if (auto note = whole_walls_note(settings, enclosure, cut); !note.empty())
    check.notes.push_back(std::move(note));
  std::vector<std::string> problems = check.problems;
  if (!known_surroundings_K(scene, surroundings_K))
    if (const auto problem = opening_problem(scene, bed, check); !problem.empty())
      problems.push_back(problem);
  if (settings.kind == RadiationKind::embree || settings.kind == RadiationKind::shading)
    for (auto& problem : sheets_that_join_their_sides(enclosure, cut)) problems.push_back(std::move(problem));
  if (!problems.empty()) throw InputError(problems);
  if (bed.size() == 0) return check.notes;
  if (settings.kind == RadiationKind::correlation)
    correlation_exchange_areas(read_correlation(settings.table), enclosure, {});
  if (settings.kind == RadiationKind::shading) refuse_what_shading_cannot_serve(enclosure, settings.rays);
  if (settings.kind == RadiationKind::lines) {
    const LineOptions options = lines_for_rays(settings.rays);
    refuse_wasted_lines(LineScene(enclosure, options.lines_per_disc), options, options.directions);
    sweep_exchange_areas(enclosure, {.directions = 1, .lines_per_disc = 1, .replicates = 2});
  }
  return check.notes;
}

}  // namespace granrad
