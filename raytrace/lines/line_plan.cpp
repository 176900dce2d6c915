#include "raytrace/lines/line_plan.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr double most_directions = 1 << 24;

/// Half the surface of the box around the hull: a convex body throws a shadow of a quarter of its surface.
double mean_shadow_m2(const LineScene& scene) {
  Box around = Box::empty();
  for (const Vec3& p : scene.hull) around.include(p);
  const Vec3 size = around.size();
  return 0.5 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// The power of the number of directions with which the error falls.
double falling_power(const std::vector<LineRound>& rounds) {
  if (rounds.size() < 2) return 1;
  const LineRound &before = rounds[rounds.size() - 2], &last = rounds.back();
  const double power = std::log(before.error / last.error) /
                       std::log(static_cast<double>(last.directions) / before.directions);
  return std::clamp(power, 0.5, 1.0);
}

}  // namespace

void check_line_options(const LineOptions& options) {
  std::vector<std::string> problems;
  if (options.directions < 1)
    problems.push_back(fmt::format("lines: directions = {} (must be at least 1)", options.directions));
  if (options.replicates < 2)
    problems.push_back(
        fmt::format("lines: replicates = {} (errors come from at least 2)", options.replicates));
  if (!(options.lines_per_disc > 0) || !std::isfinite(options.lines_per_disc))
    problems.push_back(fmt::format("lines: lines_per_disc = {} (must be positive)", options.lines_per_disc));
  if (!(options.target_error >= 0))
    problems.push_back(fmt::format("lines: target_error = {} (must not be negative)", options.target_error));
  if (!problems.empty()) throw InputError(problems);
}

int line_threads(int asked) {
  return asked > 0 ? asked : omp_get_max_threads();
}

LineOptions lines_for_rays(double rays_per_particle) {
  // In channels of hard spheres at solid fractions of .07 to .43, 24 000 ends along 250 directions against 500: heats of the
  // particles .23 against .24 and .36 against .42 % rms, those of the walls alike, in about two thirds of the time; with
  // 12 000 the walls are worse by a third.
  constexpr double enough = 16000;
  LineOptions options;
  options.lines_per_disc = rays_per_particle > enough ? 12 : 6;
  const double per_direction = 2 * options.lines_per_disc * options.replicates;
  options.directions = std::max(8, static_cast<int>(std::lround(rays_per_particle / per_direction)));
  return options;
}

void refuse_wasted_lines(const LineScene& scene, const LineOptions& options, int directions) {
  constexpr double affordable = 2e9, wasted = 20;
  const double sweeps = static_cast<double>(directions) * options.replicates;
  const double lines = sweeps * mean_shadow_m2(scene) / (scene.spacing * scene.spacing);
  const double asked = 2 * sweeps * options.lines_per_disc * static_cast<double>(scene.x.size());
  if (lines <= affordable || lines <= wasted * asked || scene.x.empty()) return;
  throw InputError(advised(
      fmt::format(
          "lines: {:.2g} lines, {:.2g} m apart, across all the space between the walls for {:.2g} that end on "
          "spheres (small spheres between far walls, or sizes too different)",
          lines, scene.spacing, asked),
      "use paths or embree, whose rays start where the spheres are, or fewer rays"));
}

int more_directions(const std::vector<LineRound>& rounds, const LineOptions& options) {
  const auto [directions, error] = rounds.back();
  const double ratio = error / options.target_error, power = falling_power(rounds);
  const double foreseen = directions * std::pow(ratio, 1 / power);
  if (foreseen > most_directions) {
    const double rays_each = 2 * options.lines_per_disc * options.replicates;
    throw ThresholdMissed(advised(
        fmt::format(
            "error = {:.3g} (reached {:.3g} with {:.2g} rays per particle, would need about {:.2g}, the most "
            "are {:.2g}, for about {:.2g})",
            options.target_error, error, directions * rays_each, foreseen * rays_each,
            most_directions * rays_each, error * std::pow(directions / most_directions, power)),
        "ask for less"));
  }
  return static_cast<int>(
      std::min(most_directions, std::ceil(directions * std::clamp(1.1 * ratio * ratio, 1.3, 4.0))));
}

}  // namespace granrad
