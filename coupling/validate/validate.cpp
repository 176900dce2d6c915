#include "coupling/validate/validate.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_model.h"
#include "coupling/simulation/radiation_check.h"
#include "coupling/simulation/radiation_source.h"
#include "coupling/validate/validate_report.h"
#include "dem/base/error.h"
#include "dem/base/files/data_folder.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/base/stated_number.h"
#include "dem/bed/solid_fraction.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "raytrace/rays/enclosure_check.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

constexpr double reference_rays_per_particle = 20000;
constexpr double reference_walks = 100000;
constexpr int reference_draws = 16;
const std::vector<double> usual_times_s = {0.01, 0.1, 1, 5};

bool any_wall(const Case& c, bool (*is)(const Wall&)) {
  return std::any_of(c.flow.walls.begin(), c.flow.walls.end(), is);
}

bool particles_and_hot_walls_are_black(const Case& c) {
  for (const Material& material : c.flow.materials)
    if (material.emissivity < 1) return false;
  return !any_wall(c, [](const Wall& w) { return w.role == WallRole::isothermal && w.emissivity < 1; });
}

RadiationSettings source(const Case& c, RadiationKind kind, double rays) {
  RadiationSettings settings;
  settings.kind = kind;
  settings.rays = rays;
  settings.seed = c.heat.radiation.seed;
  if (kind == RadiationKind::correlation)
    settings.table = c.heat.radiation.kind == RadiationKind::correlation
                         ? c.heat.radiation.table
                         : data_folder() / "correlations" / "li_2024_printed.toml";
  return settings;
}

RadiationSettings choose_reference(const Case& c) {
  if (c.heat.validate.reference) return *c.heat.validate.reference;
  const bool excluded = any_wall(c, [](const Wall& w) { return w.role == WallRole::excluded; });
  if (excluded || particles_and_hot_walls_are_black(c))
    return source(c, RadiationKind::embree, reference_rays_per_particle);
  return source(c, RadiationKind::paths, reference_walks);
}

/// Fewer rays than the reference, and another seed, so that noise is not shared.
std::vector<RadiationSettings> choose_compared(const Case& c) {
  if (!c.heat.validate.compared.empty()) return c.heat.validate.compared;
  std::vector<RadiationSettings> all = {source(c, RadiationKind::correlation, 0)};
  const auto ladder = [&](RadiationKind kind, std::initializer_list<double> rays) {
    for (double one : rays) all.push_back(source(c, kind, one));
  };
  ladder(RadiationKind::embree, {125, 500, 2000});
  if (!any_wall(c, [](const Wall& w) { return !plane_of(w); }))
    ladder(RadiationKind::lines, {1500, 6000, 24000});
  if (!any_wall(c, [](const Wall& w) { return w.role == WallRole::excluded; }))
    ladder(RadiationKind::paths, {1000, 3000, 10000});
  for (auto& settings : all) settings.seed += 1000003;
  return all;
}

std::vector<double> choose_times(const Case& c) {
  std::vector<double> times;
  for (double time : c.heat.validate.times_s.empty() ? usual_times_s : c.heat.validate.times_s)
    if (time <= c.flow.end_time_s * (1 + 1e-9) && time >= c.heat.radiation.every_s * (1 - 1e-9))
      times.push_back(time);
  if (times.empty()) times.push_back(c.flow.end_time_s);
  return times;
}

/// A bed, and the case it is heated in: a snapshot has left its feed behind, and with it the solid fraction that a
/// table would be used at.
struct NamedBed {
  std::string name;
  Bed bed;
  Case c;
};

/// Particles of a snapshot between the walls of the scene.
NamedBed bed_from(const Case& c, const fs::path& snapshot) {
  NamedBed named{snapshot.filename().string(), {}, c};
  named.c.flow.particle_file = snapshot;
  named.c.flow.feed = {};
  std::size_t left_out = 0;
  named.bed = initial_bed(named.c.flow, &left_out);
  const auto inside = in_region(named.bed, named.c.flow.region);  // the others neither conduct nor radiate
  left_out += static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 0));
  named.bed.remove_unless(inside);
  if (left_out > 0 && named.bed.size() == 0)
    throw InputError(advised(
        fmt::format("{}: all {} particles lie outside the box, or its region", snapshot.string(), left_out),
        "give the box of that snapshot"));
  if (left_out > 0)
    fmt::print(stderr,
               "note: {}: {} particles with their centre outside the box, or its region, were left out\n",
               named.name, left_out);
  named.bed.time_s = 0;
  named.bed.step = 0;
  return named;
}

std::vector<NamedBed> choose_beds(const Case& c) {
  std::vector<NamedBed> beds;
  for (const auto& note : c.flow.notes) print_message(fmt::format("note: {}", note));
  for (const auto& file : c.heat.validate.snapshots) beds.push_back(bed_from(c, file));
  if (beds.empty()) beds.push_back({c.flow.name, Flow(c.flow).first_bed(), c});
  for (const auto& named : beds)
    if (named.bed.size() == 0)
      throw InputError(
          fmt::format("{}: no particles to heat; start the feed filled, or give [particles] file or "
                      "[[validate.snapshot]]",
                      named.name));
  for (auto& named : beds)
    for (const auto& note : turn_meshes_to_particles(named.bed, c.flow.region))
      fmt::print(stderr, "note: {}: {}\n", named.name, note);
  return beds;
}

/// The reference, then those compared. One that cannot serve this bed is an error when the user asked for it,
/// else it is left out with a note.
std::vector<RadiationSettings> usable_sources(const Case& c, const Bed& bed) {
  Scene frozen = c.flow;
  frozen.engine = EngineKind::none;
  std::vector<RadiationSettings> usable = {choose_reference(c)};
  check_radiation(usable.front(), frozen, bed, c.heat.surroundings_K);
  for (const auto& settings : choose_compared(c)) {
    try {
      check_radiation(settings, frozen, bed, c.heat.surroundings_K);
      usable.push_back(settings);
    } catch (const InputError& error) {
      if (!c.heat.validate.compared.empty()) throw;
      fmt::print(stderr, "left out: {} ({})\n", source_label(settings), error.what());
    }
  }
  return usable;
}

void check_folder(const fs::path& folder) {
  if (fs::exists(folder) &&
      (!fs::is_directory(folder) || (!fs::is_empty(folder) && !fs::exists(folder / "validation.csv"))))
    throw InputError(
        fmt::format("-o {} (in use, and not by a validation) name an empty or new folder", folder.string()));
}

void print_rows(const ValidatedBed& bed) {
  fmt::print("{}: {} particles, solid fraction {:.3f}; errors against {}\n", bed.name, bed.particle_count,
             bed.solid_fraction, bed.tracks.front().label);
  constexpr std::size_t label_columns = 23;
  fmt::print("  {:<23}{:>8}{:>6}{:>9}{:>15}{:>9}{:>8}\n", "source", "rays", "t, s", "T, K", "flux off, %",
             "rms, %", "CPU s");
  for (const auto& track : bed.tracks)
    for (std::size_t k = 0; k < track.at.size(); ++k) {
      const auto with = compare(track.at[k], bed.tracks.front().at[k]);
      const bool fits = track.label.size() <= label_columns;
      if (!fits) fmt::print("  {}\n", track.label);
      fmt::print("  {:<23}{:>8.0f}{:>6g}{:>9.2f}{:>15}{:>9.3g}{:>8.3g}\n", fits ? track.label : "",
                 track.rays, track.at[k].time_s, track.at[k].mean_temperature_K,
                 fmt::format("{}{}", with.flux_error_pct > 0 ? "+" : "",
                             stated(with.flux_error_pct, with.flux_noise_pct).text(" +- ")),
                 with.own_rms_pct, track.seconds_per_update);
    }
}

/// Emissivities of the materials, for the names of beds.
double emissivity(const Case& c) {
  return c.flow.materials.front().emissivity;
}

ValidatedBed validate_bed(const NamedBed& named, const RunOptions& options) {
  const Case& c = named.c;
  const auto times = choose_times(c);
  const auto sources = usable_sources(c, named.bed);
  ValidatedBed result{
      named.name, solid_fraction(named.bed, c.flow.region), emissivity(c), named.bed.size(), {}};
  for (std::size_t k = 0; k < sources.size(); ++k) {
    Progress progress(
        fmt::format("{}, {}/{} {}", named.name, k + 1, sources.size(), source_label(sources[k])), 1,
        options.quiet());
    result.tracks.push_back(heat_frozen_bed(c, named.bed, sources[k], times, k == 0 ? reference_draws : 1,
                                            options.threads, [&](double part) { progress.update(part); }));
    if (k == 0) result.tracks.back().label += " (reference)";
    progress.finish();
  }
  result.reference_has_one_radiosity =
      sources.front().kind != RadiationKind::paths &&
      (!particles_and_hot_walls_are_black(c) ||
       any_wall(c, [](const Wall& w) { return w.role == WallRole::adiabatic; }));
  return result;
}

/// What exceeds the error asked for, at the last step of each ladder.
std::string too_far_off(const std::vector<ValidatedBed>& beds, double max_error_pct) {
  std::string problems;
  for (const auto& bed : beds)
    for (std::size_t t = 1; t < bed.tracks.size(); ++t) {
      if (!is_last_step(bed, t)) continue;
      for (std::size_t k = 0; k < bed.tracks[t].at.size(); ++k) {
        const auto with = compare(bed.tracks[t].at[k], bed.tracks.front().at[k]);
        const double worst = std::max(std::abs(with.temperature_error_pct), std::abs(with.flux_error_pct));
        if (!(worst <= max_error_pct))
          problems += fmt::format("{}{}: {} at {:g} s is off by {:.3g} % (--max-error {:g})",
                                  problems.empty() ? "" : "\n", bed.name, bed.tracks[t].label,
                                  bed.tracks[t].at[k].time_s, worst, max_error_pct);
      }
    }
  return problems;
}

}  // namespace

int validate_cases(const std::vector<Case>& cases, const fs::path& folder, const ValidateOptions& asked,
                   const RunOptions& options) {
  check_folder(folder);
  std::vector<NamedBed> beds;
  for (const Case& c : cases)
    for (auto& named : choose_beds(c)) {
      if (cases.size() > 1) named.name += fmt::format(", emissivity {:g}", emissivity(c));
      beds.push_back(std::move(named));
    }
  std::vector<ValidatedBed> validated;
  for (const auto& named : beds) {
    validated.push_back(validate_bed(named, options));
    if (!options.quiet()) print_rows(validated.back());
  }
  write_text_file(folder / "validation.csv", validation_csv(validated));
  write_text_file(folder / "particles.csv", particles_csv(validated));
  write_text_file(folder / "scene.toml", cases.front().effective_text);
  write_validation_report(folder / "report.html", "Exchange sources compared: " + cases.front().flow.name,
                          validated);
  if (!options.quiet())
    fmt::print("  {}   {}\n", (folder / "validation.csv").string(), (folder / "report.html").string());
  if (asked.max_error_pct > 0)
    if (const auto problems = too_far_off(validated, asked.max_error_pct); !problems.empty())
      throw ThresholdMissed(problems);
  return exit_ok;
}

}  // namespace granrad
