#pragma once
#include <functional>
#include <vector>

#include "fit/fitting/fit_correlation.h"

namespace granrad {

/// Samples of the snapshots of one row; called twice for each, so that those of one row at a time are in memory.
using RowSamples = std::function<std::vector<SampleSet>(std::size_t row)>;

struct TableFit {
  CorrelationTable table;
  std::vector<RowFit> rows;
};

/// A table of `count` rows, ascending in solid fraction, with its statistics; `done(part)` hears how far it is.
TableFit fit_table(std::size_t count, const RowSamples& samples, const FitOptions& options,
                   const std::function<void(double part)>& done);

}  // namespace granrad
