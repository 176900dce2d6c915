#include "fit/fitting/left_out.h"

#include <cmath>

namespace granrad {

LeftOut left_out(const CorrelationTable& table, std::size_t row, const std::vector<SampleSet>& snapshots,
                 const FitOptions& options) {
  if (row == 0 || row + 1 >= table.rows.size()) return {};
  CorrelationTable others = table;
  others.rows.erase(others.rows.begin() + static_cast<std::ptrdiff_t>(row));
  const Correlation between(others, table.rows[row].solid_fraction);
  double pp = 0, pw = 0, pairs = 0, walls = 0;
  for (const auto& set : snapshots) {
    const auto samples = fitted_samples(set, options);
    for (std::size_t k = 0; k < samples.pairs.size(); ++k, ++pairs) {
      const double off = between.pp(samples.pairs.distance[k]) - samples.pairs.factor[k];
      pp += off * off;
    }
    for (std::size_t k = 0; k < samples.walls.size(); ++k, ++walls) {
      const double off =
          between.pw(samples.walls.distance[k], samples.walls.unobstructed[k]) - samples.walls.factor[k];
      pw += off * off;
    }
  }
  return {std::sqrt(pp / pairs), std::sqrt(pw / walls)};
}

}  // namespace granrad
