#include "fit/fitting/distance_bins.h"

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {

constexpr double bin_width = 0.05;

struct Sums {
  double count = 0, distance = 0, factor = 0, fitted = 0, residual2 = 0, noise = 0;
};

}  // namespace

std::vector<DistanceBin> distance_bins(const std::vector<const DistanceSamples*>& snapshots,
                                       const std::vector<double>& fitted) {
  std::vector<Sums> sums;
  std::size_t at = 0;
  for (const auto* samples : snapshots)
    for (std::size_t k = 0; k < samples->size(); ++k, ++at) {
      const auto bin = static_cast<std::size_t>(std::max(0.0, samples->distance[k]) / bin_width);
      if (bin >= sums.size()) sums.resize(bin + 1);
      const double residual = samples->factor[k] - fitted[at];
      Sums& s = sums[bin];
      s.count += 1;
      s.distance += samples->distance[k];
      s.factor += samples->factor[k];
      s.fitted += fitted[at];
      s.residual2 += residual * residual;
      s.noise += samples->variance[k];
    }
  std::vector<DistanceBin> bins;
  for (const auto& s : sums) {
    if (s.count == 0) continue;
    const double mean_residual = (s.factor - s.fitted) / s.count;
    const double spread2 = s.residual2 / s.count - mean_residual * mean_residual;
    bins.push_back({.distance = s.distance / s.count,
                    .count = static_cast<std::size_t>(s.count),
                    .mean = s.factor / s.count,
                    .fitted = s.fitted / s.count,
                    .scatter2 = spread2 - s.noise / s.count,
                    .mean_error = std::sqrt(std::max(0.0, spread2) / s.count)});
  }
  return bins;
}

double overall_scatter(const std::vector<DistanceBin>& bins) {
  double sum = 0, count = 0;
  for (const auto& bin : bins) {
    sum += static_cast<double>(bin.count) * bin.scatter2;
    count += static_cast<double>(bin.count);
  }
  return count > 0 ? std::sqrt(std::max(0.0, sum / count)) : 0;
}

}  // namespace granrad
