#pragma once
#include <optional>
#include <vector>

#include "raytrace/paths/path_starts.h"
#include "raytrace/paths/path_tally.h"

namespace granrad {

/// What a rank found of each batch; nothing of those it did not work at.
using BatchTallies = std::vector<std::optional<PathTally>>;

/// Heats become clear_flight_parts (heat - lambda clear_heat), in whole parts, so that they still sum to 0. Each batch has the
/// lambda in [0, 1] that takes most noise out of the wall heat of all other batches of all ranks: having nothing to do with
/// its own walks, it leaves their mean alone.
inline constexpr int clear_flight_parts = 64;
void take_out_clear_flights(BatchTallies& found);

/// A sum over all batches and the standard error of that sum, from their scatter; in quanta.
struct SumAndError {
  double total, error;
};

struct BatchSums {
  std::vector<SumAndError> surface;
  SumAndError given;  ///< by all walls
  std::int64_t segments = 0, lost = 0;
};

/// The sums of all ranks. Each rank sums up a part of the surfaces: it gets what the others found of them, which costs
/// every rank 16 bytes a surface for each batch it worked at, and hands the results round.
BatchSums sum_batches(const BatchTallies& found, const PathSurfaces& surfaces);

}  // namespace granrad
