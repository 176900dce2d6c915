#include "coupling/simulation/radiation_scene.h"

#include <fmt/core.h>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/correlation.h"
#include "raytrace/paths/path_tracer.h"

namespace granrad {

namespace {

constexpr double default_radiation_interval_s = 0.01;
constexpr double default_heat_error = 0.01;
constexpr double default_walks = 10000;  // paths, per update: 1 % noise in the wall heat needs about 1300
constexpr double default_rays_per_particle = 2000;
constexpr double default_line_ends_per_particle = 24000;  // 500 directions; lines are far cheaper than rays

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
  const bool paths = settings.kind == RadiationKind::paths;
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

}  // namespace granrad
