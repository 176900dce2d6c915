#pragma once
#include <vector>

#include "fit/fitting/fit_correlation.h"

namespace granrad {

/// How well a table does at a solid fraction it does not list: root mean square of the samples about the table
/// without row `row`, interpolated from its neighbours, within its bounds. 0 for the first and last rows, which
/// have no two neighbours.
struct LeftOut {
  double pp_rmse = 0, pw_rmse = 0;
};
LeftOut left_out(const CorrelationTable& table, std::size_t row, const std::vector<SampleSet>& snapshots,
                 const FitOptions& options);

}  // namespace granrad
