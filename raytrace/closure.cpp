#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/scene/error.h"
#include "raytrace/exchange.h"

namespace granrad {

namespace {

constexpr double row_tolerance = 1e-12;
constexpr int most_sweeps = 20000;
constexpr std::size_t worth_threads = 100000;  // pairs; below, waking threads costs more than the work

/// Entry (i, j) of a sparse matrix, or -1.
std::int64_t find(const SparsePattern& p, std::size_t i, std::int32_t j) {
  const auto begin = p.column.begin() + p.row_begin[i], end = p.column.begin() + p.row_begin[i + 1];
  const auto at = std::lower_bound(begin, end, j);
  return at != end && *at == j ? at - p.column.begin() : -1;
}

/// Both one-way estimates of a pair, as one. `w` is the weight, rays per area.
struct Pair {
  double x_ij = 0, x_ji = 0, v_ij = 0, v_ji = 0, w_i = 0, w_j = 0;

  double merged() const { return w_i + w_j > 0 ? (w_i * x_ij + w_j * x_ji) / (w_i + w_j) : 0; }
  double merged_variance() const {
    const double sum = w_i + w_j;
    return sum > 0 ? (w_i * w_i * v_ij + w_j * w_j * v_ji) / (sum * sum) : 0;
  }
  /// Of x_ij - x_ji when both count the same X: pooled, because a count that came out low also claims a low
  /// variance, and chi^2 from each one's own would exceed 1 for rare pairs.
  double null_variance() const {
    const double own = v_ij + v_ji, poisson = (x_ij + 0.5 / w_i) / w_i + (x_ji + 0.5 / w_j) / w_j;
    return merged() * (1 / w_i + 1 / w_j) * own / poisson;
  }
};

class PairReader {
 public:
  explicit PairReader(const ExchangeAreas& e) : e_(e), open_(e.area_m2.size() - 1) {}

  Pair read(std::size_t i, std::size_t j) const {
    const auto ij = find(e_.pattern, i, static_cast<std::int32_t>(j));
    const auto ji = find(e_.pattern, j, static_cast<std::int32_t>(i));
    Pair p;
    p.w_i = weight(i);
    p.w_j = weight(j);
    if (ij >= 0) p.x_ij = e_.value[ij];
    if (ji >= 0) p.x_ji = e_.value[ji];
    if (!e_.variance.empty()) {
      p.v_ij = ij >= 0 ? e_.variance[ij] : never_hit(i);
      p.v_ji = ji >= 0 ? e_.variance[ji] : never_hit(j);
    }
    return p;
  }
  bool symmetric() const { return e_.rays_per_m2.empty(); }

 private:
  double weight(std::size_t i) const {
    if (!e_.rays_per_m2.empty()) return e_.rays_per_m2[i];
    return i == open_ && e_.pattern.row_begin[i] == e_.pattern.row_begin[i + 1] ? 0 : 1;
  }
  /// Half a hit, as the regularised variance of a count has it.
  double never_hit(std::size_t i) const {
    const double w = weight(i);
    return e_.rays_per_m2.empty() || w == 0 ? 0 : 0.5 / (w * w);
  }
  const ExchangeAreas& e_;
  std::size_t open_;
};

/// Merges the one-way estimates on the symmetrised pattern and reports how far apart they were.
ExchangeAreas merge(const ExchangeAreas& estimate, ClosureReport& report) {
  ExchangeAreas m;
  m.pattern = symmetrized(estimate.pattern);
  m.area_m2 = estimate.area_m2;
  m.value.resize(m.pattern.column.size());
  if (!estimate.variance.empty()) m.variance.resize(m.value.size());
  const PairReader reader(estimate);
  const std::size_t n = m.area_m2.size();
  std::vector<double> difference2(n, 0), sum2(n, 0), chi2(n, 0);
  std::vector<std::int64_t> compared(n, 0);
#pragma omp parallel for schedule(dynamic, 64) if (m.value.size() > worth_threads)
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = m.pattern.row_begin[i]; k < m.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(m.pattern.column[k]);
      const Pair p =
          reader.read(std::min(i, j), std::max(i, j));  // one order: the two halves get the same bits
      m.value[k] = p.merged();
      if (!m.variance.empty())
        m.variance[k] = reader.symmetric() ? 0.5 * (p.v_ij + p.v_ji) : p.merged_variance();
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
  const auto total = [](const auto& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  if (total(sum2) > 0) report.reciprocity_defect = std::sqrt(total(difference2) / total(sum2));
  if (total(compared) > 0) report.reciprocity_chi2 = total(chi2) / total(compared);
  return m;
}

double row_sum(const ExchangeAreas& x, std::size_t i) {
  return std::accumulate(x.value.begin() + x.pattern.row_begin[i],
                         x.value.begin() + x.pattern.row_begin[i + 1], 0.0);
}

bool closes(const ExchangeAreas& x, std::size_t i) {
  return i + 1 < x.area_m2.size() && x.area_m2[i] > 0;
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

/// Symmetric Sinkhorn: the factors x_i that make every row of x_i X_ij x_j sum to its area.
std::vector<double> balancing_factors(const ExchangeAreas& x, int& sweeps) {
  const std::size_t n = x.area_m2.size();
  std::vector<double> factor(n, 1), ratio(n, 1);
  for (sweeps = 0; sweeps < most_sweeps; ++sweeps) {
#pragma omp parallel for schedule(dynamic, 256) if (x.value.size() > worth_threads)
    for (std::size_t i = 0; i < n; ++i) {
      if (!closes(x, i)) continue;
      double sum = 0;
      for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
        sum += x.value[k] * factor[static_cast<std::size_t>(x.pattern.column[k])];
      ratio[i] = x.area_m2[i] / (factor[i] * sum);
    }
    double worst = 0;
    for (const double r : ratio) worst = std::isfinite(r) ? std::max(worst, std::abs(r - 1)) : HUGE_VAL;
    if (worst <= 0.1 * row_tolerance || (worst <= row_tolerance && sweeps > most_sweeps / 2)) return factor;
    if (!std::isfinite(worst)) break;
    for (std::size_t i = 0; i < n; ++i) factor[i] *= std::sqrt(ratio[i]);
  }
  const auto worst = std::max_element(ratio.begin(), ratio.end(),
                                      [](double a, double b) { return std::abs(a - 1) < std::abs(b - 1); });
  throw NumericalError(
      fmt::format("closure: row {} stays {:.1e} away from its area after {} sweeps (it sees only "
                  "surfaces that cannot fill it: more rays, or another enclosure)",
                  worst - ratio.begin(), std::abs(*worst - 1), sweeps));
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
  merge(one_way, report);
  return report.reciprocity_chi2;
}

ExchangeAreas close(const ExchangeAreas& estimate, Closure closure, ClosureReport& report) {
  report = {};
  for (const double value : estimate.value)
    if (!std::isfinite(value) || value < 0)
      throw NumericalError(
          fmt::format("closure: an exchange area is {} (must be finite and not negative)", value));
  ExchangeAreas closed = merge(estimate, report);
  if (closure == Closure::row_sum) closed = unmerged(estimate, closed);
  require_rows(closed);
  report.closure_defect = closure_defect(closed);
  if (closure == Closure::reciprocal)
    scale_symmetric(closed, report);
  else
    scale_rows(closed, report);
  reflect_open(closed);
  return closed;
}

}  // namespace granrad
