#pragma once
#include <optional>
#include <vector>

#include "raytrace/paths/path_starts.h"
#include "raytrace/paths/path_tally.h"

namespace granrad {

/// What a rank found of each batch; nothing of those it did not work at.
using BatchTallies = std::vector<std::optional<PathTally>>;

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
