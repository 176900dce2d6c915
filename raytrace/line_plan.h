#pragma once
#include "raytrace/line_sweep.h"

namespace granrad {

/// Throws InputError with every option that makes no sense.
void check_line_options(const LineOptions& options);

/// Number of threads to use: `asked`, or OpenMP's default for 0.
int line_threads(int asked);

/// Directions for the next attempt when `error` was found and `target` is wanted: enough if the error fell as
/// slowly as that of random directions, at most four times as many. Throws ThresholdMissed past 2^24.
int more_directions(int directions, double error, double target);

}  // namespace granrad
