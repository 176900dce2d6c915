#include "fit/generate/curve_error.h"

#include <cmath>

#include "dem/base/constants.h"
#include "fit/fitting/samples.h"
#include "fit/fitting/student.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

double curve_error(const std::vector<std::filesystem::path>& traced) {
  constexpr double nearest = 1.5, farthest = 2.5;
  if (traced.size() < 2) return infinity;
  double sum = 0, sum2 = 0;
  const double n = static_cast<double>(traced.size());
  for (const auto& file : traced) {
    const auto read = read_view_factors(file);
    const auto samples = make_samples(read.enclosure, read.counts, farthest, file.string());
    double factor = 0, count = 0;
    for (std::size_t k = 0; k < samples.pairs.size(); ++k)
      if (samples.pairs.distance[k] > nearest) factor += samples.pairs.factor[k], ++count;
    sum += factor / count;
    sum2 += factor / count * (factor / count);
  }
  const double mean = sum / n, variance = std::max(0.0, sum2 / n - mean * mean) * n / (n - 1);
  return student_widening(traced.size()) * std::sqrt(variance / n) / mean;
}

}  // namespace granrad
