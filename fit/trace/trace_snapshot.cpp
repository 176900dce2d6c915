#include "fit/trace/trace_snapshot.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "dem/base/error.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"

namespace granrad {

namespace {

std::string names_of(const std::vector<Wall>& walls) {
  std::string names;
  for (const Wall& wall : walls) names += (names.empty() ? "" : ", ") + wall.name;
  return names;
}

/// Number of the wall of this name, or -1.
std::ptrdiff_t wall_named(const Enclosure& enclosure, const std::string& name) {
  const auto at = std::find_if(enclosure.walls.begin(), enclosure.walls.end(),
                               [&](const Wall& wall) { return wall.name == name; });
  return at == enclosure.walls.end() ? -1 : at - enclosure.walls.begin();
}

/// Surface numbers of walls that are there.
std::vector<std::int32_t> surfaces_of(const Enclosure& enclosure, const std::vector<std::string>& names) {
  std::vector<std::int32_t> found;
  for (const std::string& name : names)
    found.push_back(static_cast<std::int32_t>(enclosure.sphere_count()) +
                    static_cast<std::int32_t>(wall_named(enclosure, name)));
  return found;
}

bool is_grey(const TraceSettings& settings) {
  return settings.emissivity || settings.wall_emissivity;
}

/// The lines of the rays asked for, as a run traces them; of an error asked for, a first round of few.
LineOptions line_options(const TraceSettings& settings, std::vector<std::int32_t> hot_walls) {
  LineOptions options;
  if (settings.error > 0)
    options.directions = 16;
  else
    options = lines_for_rays(settings.rays);
  options.seed = settings.seed;
  options.threads = settings.threads;
  options.target_error = settings.error;
  options.hot_walls = std::move(hot_walls);
  options.memory_limit_bytes = settings.memory_limit_bytes;
  options.watch = settings.watch;
  return options;
}

TraceOptions embree_options(const TraceSettings& settings, std::vector<std::int32_t> hot_walls) {
  TraceOptions options;
  options.rays_per_particle = settings.rays;
  options.target_error = settings.error;
  options.hot_walls = std::move(hot_walls);
  options.sampling = settings.sampling;
  options.seed = settings.seed;
  options.threads = settings.threads;
  options.memory_limit_bytes = settings.memory_limit_bytes;
  options.watch = settings.watch;
  return options;
}

HitCounts sweep(const Enclosure& enclosure, const LineOptions& options, TraceReport& spent) {
  const auto start = std::chrono::steady_clock::now();
  LineReport report;
  HitCounts counts = sweep_view_factors(enclosure, options, &report);
  spent.rays = report.ray_equivalents;
  spent.rounds = report.rounds;
  spent.error = report.estimated_error;
  spent.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return counts;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

std::vector<double> surface_emissivities(const Enclosure& enclosure, const TraceSettings& settings) {
  std::vector<double> emissivity(enclosure.surface_count(), settings.emissivity.value_or(1));
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    emissivity[enclosure.sphere_count() + w] =
        settings.wall_emissivity.value_or(enclosure.walls[w].emissivity);
  emissivity.back() = 1;
  return emissivity;
}

}  // namespace

const char* to_string(TraceMethod method) {
  return method == TraceMethod::lines ? "lines" : "embree";
}

void require_traceable(const Enclosure& enclosure, const TraceSettings& settings,
                       const std::string& snapshot) {
  std::vector<std::string> problems;
  const auto problem = [&](const std::string& cause, const std::string& advice) {
    problems.push_back(advised(cause, advice));
  };
  if (enclosure.sphere_count() == 0 && enclosure.walls.empty())
    problem(snapshot + ": no surface to trace (neither particles nor walls)", "add walls with --box");
  if (settings.method == TraceMethod::lines && is_grey(settings))
    problem("--emissivity: lines trace black surfaces (a path of reflections is no straight line)",
            "use --method embree");
  if (settings.method == TraceMethod::lines && settings.sampling == Sampling::plain)
    problem("--sampling: random (lines have a sequence of their own)", "use --method embree");
  if (enclosure.sphere_count() == 0 && (settings.error > 0 || !settings.hot_walls.empty()))
    problem("--error: " + snapshot + " has no particles (the stated errors are theirs)", "use --rays");
  for (const std::string& name : settings.hot_walls)
    if (wall_named(enclosure, name) < 0)
      problem(fmt::format("--hot-walls: {} (no such wall; there are: {})", name,
                          enclosure.walls.empty() ? "none" : names_of(enclosure.walls)),
              enclosure.walls.empty() ? "add --box" : "name one of them");
  if (!problems.empty()) throw InputError(problems);
}

ViewFactorFile trace(const Enclosure& enclosure, const TraceSettings& settings, const std::string& origin) {
  require_traceable(enclosure, settings, origin);
  const auto hot_walls = surfaces_of(enclosure, settings.hot_walls);
  ViewFactorFile traced;
  traced.enclosure = enclosure;
  traced.method = to_string(settings.method);
  traced.origin = origin;
  traced.seed = settings.seed;
  traced.error_target = settings.error;
  traced.hot_walls = joined(settings.hot_walls);
  traced.sampling = settings.method == TraceMethod::lines  ? "lines"
                    : settings.sampling == Sampling::sobol ? "sobol"
                                                           : "random";
  if (is_grey(settings)) {
    traced.emissivity = surface_emissivities(enclosure, settings);
    traced.counts = trace_total_exchange(enclosure, traced.emissivity, embree_options(settings, hot_walls),
                                         &traced.spent);
  } else if (settings.method == TraceMethod::lines) {
    traced.counts = sweep(enclosure, line_options(settings, hot_walls), traced.spent);
  } else {
    traced.counts = trace_view_factors(enclosure, embree_options(settings, hot_walls), &traced.spent);
  }
  traced.check = self_check(enclosure, traced.counts);
  ClosureReport report;
  traced.closed = close(one_way_estimate(traced.counts), traced.closure, report);
  traced.closure_correction_max = report.largest_correction;
  return traced;
}

std::string spent_line(const ViewFactorFile& traced) {
  const TraceReport& spent = traced.spent;
  std::string line = fmt::format("spent {:.3g} rays in {} round{}, {:.2g} s", static_cast<double>(spent.rays),
                                 spent.rounds, spent.rounds == 1 ? "" : "s", spent.seconds);
  if (traced.enclosure.sphere_count() > 0) {
    line += fmt::format("; error {:.3g} % of the ", 100 * spent.error);
    line += traced.hot_walls.empty() ? "particle-wall sums"
                                     : fmt::format("particle fluxes from {}", traced.hot_walls);
    if (traced.error_target > 0) line += fmt::format(" ({:.3g} % asked for)", 100 * traced.error_target);
  }
  if (traced.counts.thinning_unit > 1)
    line += fmt::format(
        "; to stay within the memory allowed, pairs of fewer than {0} hits were kept at random, as {0}",
        traced.counts.thinning_unit);
  return line;
}

std::string self_check_line(const SelfCheck& check) {
  return fmt::format(
      "self-check {}: closure {:.1e}, reciprocity chi2 {:.3f}, mean chord {}, leaked rays {}",
      check.failed.empty() ? "passed" : "FAILED (" + check.failed + ")", check.closure_defect,
      check.reciprocity_chi2,
      check.mean_chord_ratio > 0 ? fmt::format("{:.4f} of 4V/S", check.mean_chord_ratio) : "not known",
      check.leaked);
}

}  // namespace granrad
