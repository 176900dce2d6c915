#pragma once
#include <vector>

#include "raytrace/line_pass/line_scene.h"
#include "raytrace/lines/line_sweep.h"

namespace granrad {

/// Throws InputError with every option that makes no sense.
void check_line_options(const LineOptions& options);

/// Number of threads to use: `asked`, or OpenMP's default for 0.
int line_threads(int asked);

/// Options that give `rays_per_particle` line ends to a small sphere: every line through its disc ends on it twice.
/// Directions first, as the heats of walls need; above 16 000 ends twice as many lines per disc, as the fluxes of single
/// particles do.
LineOptions lines_for_rays(double rays_per_particle);

/// Throws InputError for a sweep of more than 2e9 lines (half a minute of a core and more) nearly all of which no sphere
/// asked for: over 20 times the line ends that the options give the spheres. So it is with small spheres between far walls,
/// and with a few large spheres among small ones. Knows this before the first line.
void refuse_wasted_lines(const LineScene& scene, const LineOptions& options, int directions);

/// An attempt and the error it found.
struct LineRound {
  int directions;
  double error;
};

/// Directions for the next attempt when options.target_error was missed: enough if the error fell as slowly
/// as that of random directions, at most four times as many. Throws ThresholdMissed as soon as the target is
/// foreseen to take more than 2^24 of them, and says what they would reach: the error is taken to fall as it
/// did in the last two rounds, but no slower than for random directions (power 1/2) and no faster than for
/// evenly spread ones (power 1), which is assumed after the first round.
int more_directions(const std::vector<LineRound>& rounds, const LineOptions& options);

}  // namespace granrad
