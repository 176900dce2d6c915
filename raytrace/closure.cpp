#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "raytrace/balancing.h"
#include "raytrace/exchange.h"

namespace granrad {

namespace {

constexpr std::size_t worth_threads = 100000;  // pairs; below, waking threads costs more than the work

/// Entry (i, j) of a sparse matrix, or -1.
std::int64_t find(const SparsePattern& p, std::size_t i, std::int32_t j) {
  const auto begin = p.column.begin() + p.row_begin[i], end = p.column.begin() + p.row_begin[i + 1];
  const auto at = std::lower_bound(begin, end, j);
  return at != end && *at == j ? at - p.column.begin() : -1;
}

/// Both one-way estimates of a pair, as one. `w` is the weight, rays per area.
struct TwoWay {
  double x_ij = 0, x_ji = 0, v_ij = 0, v_ji = 0, w_i = 0, w_j = 0;

  double share_i() const { return w_i + w_j > 0 ? w_i / (w_i + w_j) : 0; }
  double share_j() const { return w_i + w_j > 0 ? w_j / (w_i + w_j) : 0; }
  double merged() const { return share_i() * x_ij + share_j() * x_ji; }
  /// Variance of the merged value, by whose rays it is.
  double variance_of_i() const { return share_i() * share_i() * v_ij; }
  double variance_of_j() const { return share_j() * share_j() * v_ji; }
  /// Of x_ij - x_ji when both count the same X: pooled, because a count that came out low also claims a low
  /// variance, and chi^2 from each one's own would exceed 1 for rare pairs.
  double null_variance() const {
    const double own = v_ij + v_ji, poisson = x_ij / w_i + x_ji / w_j;
    return merged() * (1 / w_i + 1 / w_j) * own / poisson;
  }
};

class PairReader {
 public:
  explicit PairReader(const ExchangeAreas& e) : e_(e), open_(e.area_m2.size() - 1) {}

  TwoWay read(std::size_t i, std::size_t j) const {
    const auto ij = find(e_.pattern, i, static_cast<std::int32_t>(j));
    const auto ji = find(e_.pattern, j, static_cast<std::int32_t>(i));
    TwoWay p;
    p.w_i = weight(i);
    p.w_j = weight(j);
    if (ij >= 0) p.x_ij = e_.value[ij];
    if (ji >= 0) p.x_ji = e_.value[ji];
    if (!e_.variance.empty()) {
      if (ij >= 0) p.v_ij = e_.variance[ij];
      if (ji >= 0) p.v_ji = e_.variance[ji];
    }
    return p;
  }
  bool symmetric() const { return e_.rays_per_m2.empty(); }

 private:
  double weight(std::size_t i) const {
    if (!e_.rays_per_m2.empty()) return e_.rays_per_m2[i];
    return i == open_ && e_.pattern.row_begin[i] == e_.pattern.row_begin[i + 1] ? 0 : 1;
  }
  const ExchangeAreas& e_;
  std::size_t open_;
};

/// What closure needs to know of the noise of merged pairs. The counts of a row add up to its rays: noise in
/// a pair (i, j) from the rays of i moves the sum of row j, but that of row i only as far as its pairs are
/// merged with different weights.
struct MergedNoise {
  std::vector<float> of_other;       ///< [nnz] variance of pair (i, j) from the rays of j
  std::vector<double> row_variance;  ///< [surfaces] of the sum of row i
  bool symmetric = false;            ///< no rays of either end: all noise of a pair moves both sums
};

/// Sums over the pairs of one row, for the part of its own rays in the variance of its sum: with shares w_k,
/// multinomial counts x_k of A in all give sum v_k (1 - (sum w_k x_k)^2 / (A sum w_k^2 x_k)).
struct OwnRays {
  double variance = 0, wx = 0, wwx = 0;
  void add(double share, double x, double v) {
    variance += v;
    wx += share * x;
    wwx += share * share * x;
  }
  double of_sum(double area) const {
    return wwx > 0 ? variance * std::max(0.0, 1 - wx * wx / (area * wwx)) : 0;
  }
};

/// Merges the one-way estimates on the symmetrised pattern and reports how far apart they were.
ExchangeAreas merge(const ExchangeAreas& estimate, ClosureReport& report, MergedNoise& noise) {
  ExchangeAreas m;
  m.pattern = symmetrized(estimate.pattern);
  m.area_m2 = estimate.area_m2;
  m.value.resize(m.pattern.column.size());
  const PairReader reader(estimate);
  const std::size_t n = m.area_m2.size();
  noise.symmetric = reader.symmetric();
  noise.row_variance.assign(n, 0);
  if (!estimate.variance.empty()) {
    m.variance.resize(m.value.size());
    noise.of_other.resize(m.value.size());
  }
  std::vector<double> difference2(n, 0), sum2(n, 0), chi2(n, 0);
  std::vector<std::int64_t> compared(n, 0);
#pragma omp parallel for schedule(dynamic, 64) if (m.value.size() > worth_threads)
  for (std::size_t i = 0; i < n; ++i) {
    OwnRays own;
    for (std::int64_t k = m.pattern.row_begin[i]; k < m.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(m.pattern.column[k]);
      const TwoWay p =
          reader.read(std::min(i, j), std::max(i, j));  // one order: the two halves get the same bits
      m.value[k] = p.merged();
      if (!m.variance.empty() && reader.symmetric()) {
        m.variance[k] = 0.5 * (p.v_ij + p.v_ji);
        noise.of_other[k] = static_cast<float>(m.variance[k]);
        noise.row_variance[i] += m.variance[k];
      } else if (!m.variance.empty() && i == j) {  // one count, read twice
        m.variance[k] = p.v_ij;
        own.add(1, p.x_ij, p.v_ij);
      } else if (!m.variance.empty()) {
        m.variance[k] = p.variance_of_i() + p.variance_of_j();
        const double of_other = i < j ? p.variance_of_j() : p.variance_of_i();
        noise.of_other[k] = static_cast<float>(of_other);
        noise.row_variance[i] += of_other;
        own.add(i < j ? p.share_i() : p.share_j(), i < j ? p.x_ij : p.x_ji, m.variance[k] - of_other);
      }
      if (j <= i || p.w_i == 0 || p.w_j == 0) continue;
      const double difference = p.x_ij - p.x_ji;
      difference2[i] += difference * difference;
      sum2[i] += m.value[k] * m.value[k];
      const double variance = m.variance.empty() || reader.symmetric() ? 0 : p.null_variance();
      if (variance > 0) {
        chi2[i] += difference * difference / variance;
        ++compared[i];
      }
    }
    if (m.area_m2[i] > 0) noise.row_variance[i] += own.of_sum(m.area_m2[i]);
  }
  const auto total = [](const auto& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  if (total(sum2) > 0) report.reciprocity_defect = std::sqrt(total(difference2) / total(sum2));
  if (total(compared) > 0) report.reciprocity_chi2 = total(chi2) / total(compared);
  return m;
}

double square(double x) {
  return x * x;
}

double row_sum(const ExchangeAreas& x, std::size_t i) {
  return std::accumulate(x.value.begin() + x.pattern.row_begin[i],
                         x.value.begin() + x.pattern.row_begin[i + 1], 0.0);
}

void require_rows(const ExchangeAreas& x) {
  for (std::size_t i = 0; i < x.area_m2.size(); ++i)
    if (closes(x, i) && !(row_sum(x, i) > 0))
      throw NumericalError(fmt::format("closure: surface {} sees nothing (more rays, or drop it)", i));
}

double closure_defect(const ExchangeAreas& x) {
  double worst = 0;
  for (std::size_t i = 0; i < x.area_m2.size(); ++i)
    if (closes(x, i)) worst = std::max(worst, std::abs(row_sum(x, i) / x.area_m2[i] - 1));
  return worst;
}

/// Closing to first order: X_ij + e_ij becomes X_ij + e_ij + X_ij (d_i + d_j), d_i = -(noise of the sum of
/// row i) / A_i. The pair's own noise is in those sums too and partly taken back; that of the other pairs is
/// new.
void close_variances(ExchangeAreas& x, const MergedNoise& noise) {
#pragma omp parallel for schedule(dynamic, 256) if (x.value.size() > worth_threads)
  for (std::size_t i = 0; i < x.area_m2.size(); ++i)
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(x.pattern.column[k]);
      const double f_ij = closes(x, i) ? std::min(1.0, x.value[k] / x.area_m2[i]) : 0;
      const double f_ji = closes(x, j) ? std::min(1.0, x.value[k] / x.area_m2[j]) : 0;
      const double of_j = noise.of_other[k], of_i = noise.symmetric ? of_j : x.variance[k] - of_j;
      if (i == j) {
        x.variance[k] += square(2 * f_ij) * noise.row_variance[i];
        continue;
      }
      const double kept = noise.symmetric ? of_j * square(1 - f_ij - f_ji)
                                          : of_i * square(1 - f_ji) + of_j * square(1 - f_ij);
      x.variance[k] = kept + f_ij * f_ij * std::max(0.0, noise.row_variance[i] - of_j) +
                      f_ji * f_ji * std::max(0.0, noise.row_variance[j] - of_i);
    }
}

void scale_symmetric(ExchangeAreas& x, ClosureReport& report) {
  const std::vector<double> factor = balancing_factors(x, report.sweeps);
  for (std::size_t i = 0; i < factor.size(); ++i) {
    report.largest_correction = std::max(report.largest_correction, std::abs(factor[i] - 1));
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const double scale = factor[i] * factor[static_cast<std::size_t>(x.pattern.column[k])];
      x.value[k] *= scale;
      if (!x.variance.empty()) x.variance[k] *= scale * scale;
    }
  }
}

void scale_rows(ExchangeAreas& x, ClosureReport& report) {
  for (std::size_t i = 0; i < x.area_m2.size(); ++i) {
    if (!closes(x, i)) continue;
    const double scale = x.area_m2[i] / row_sum(x, i);
    report.largest_correction = std::max(report.largest_correction, std::abs(scale - 1));
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      x.value[k] *= scale;
      if (!x.variance.empty()) x.variance[k] *= scale * scale;
    }
  }
}

/// Gives the surroundings the row that the others' columns imply.
void reflect_open(ExchangeAreas& x) {
  const std::size_t open = x.area_m2.size() - 1;
  x.area_m2[open] = 0;
  for (std::int64_t k = x.pattern.row_begin[open]; k < x.pattern.row_begin[open + 1]; ++k) {
    const auto other =
        find(x.pattern, static_cast<std::size_t>(x.pattern.column[k]), static_cast<std::int32_t>(open));
    x.value[k] = x.value[other];
    if (!x.variance.empty()) x.variance[k] = x.variance[other];
    x.area_m2[open] += x.value[k];
  }
}

/// The estimate on its symmetrised pattern, unmerged.
ExchangeAreas unmerged(const ExchangeAreas& estimate, const ExchangeAreas& merged) {
  ExchangeAreas x = merged;
  for (std::size_t i = 0; i < x.area_m2.size(); ++i)
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto at = find(estimate.pattern, i, x.pattern.column[k]);
      x.value[k] = at >= 0 ? estimate.value[at] : 0;
      if (!x.variance.empty()) x.variance[k] = at >= 0 ? estimate.variance[at] : 0;
    }
  return x;
}

}  // namespace

double reciprocity_chi2(const ExchangeAreas& one_way) {
  ClosureReport report;
  MergedNoise noise;
  merge(one_way, report, noise);
  return report.reciprocity_chi2;
}

double reciprocity_rms(const ExchangeAreas& x, std::size_t surfaces) {
  double squares = 0, pairs = 0;
  for (std::size_t i = 0; i < surfaces; ++i)
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(x.pattern.column[k]);
      if (j <= i || j >= surfaces || !closes(x, i) || !closes(x, j)) continue;
      const double other = x.value[find(x.pattern, j, static_cast<std::int32_t>(i))];
      if (x.value[k] == 0 && other == 0) continue;
      squares += std::pow(x.value[k] - other, 2) / (x.area_m2[i] * x.area_m2[j]);
      pairs += 1;
    }
  return pairs > 0 ? std::sqrt(squares / pairs) : 0;
}

ExchangeAreas close(const ExchangeAreas& estimate, Closure closure, ClosureReport& report) {
  report = {};
  for (const double value : estimate.value)
    if (!std::isfinite(value) || value < 0)
      throw NumericalError(
          fmt::format("closure: an exchange area is {} (must be finite and not negative)", value));
  MergedNoise noise;
  ExchangeAreas closed = merge(estimate, report, noise);
  if (closure == Closure::row_sum) closed = unmerged(estimate, closed);
  require_rows(closed);
  report.closure_defect = closure_defect(closed);
  if (closure == Closure::reciprocal) {
    if (!closed.variance.empty()) close_variances(closed, noise);
    scale_symmetric(closed, report);
  } else {
    scale_rows(closed, report);
  }
  reflect_open(closed);
  return closed;
}

}  // namespace granrad
