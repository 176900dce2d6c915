#pragma once
#include <vector>

#include "fit/fitting/fit_correlation.h"

namespace granrad {

/// Bins of equal width in distance (0.05 d), with the mean of the samples, of the curve, and the noise-free
/// scatter of the samples about the curve shifted to the bin's mean. `fitted` [samples] is the curve at each
/// sample.
std::vector<DistanceBin> distance_bins(const std::vector<const DistanceSamples*>& snapshots,
                                       const std::vector<double>& fitted);

/// Scatter of all samples: root of the mean, over the samples, of the bins' scatter2.
double overall_scatter(const std::vector<DistanceBin>& bins);

}  // namespace granrad
