#include "raytrace/balancing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "raytrace/conjugate_gradients.h"

namespace granrad {

namespace {

constexpr double row_tolerance = 1e-12;
constexpr int sweeps_before_newton = 400, most_newton_steps = 40, most_sweeps = 20000;
constexpr std::size_t worth_threads = 100000;  // pairs; below, waking threads costs more than the work

using Values = std::vector<double>;

/// sum_j X_ij v_j of every row that closes, over `columns` that close or all; 0 elsewhere.
Values times(const ExchangeAreas& x, const Values& v, bool only_closing) {
  Values product(v.size(), 0);
#pragma omp parallel for schedule(dynamic, 256) if (x.value.size() > worth_threads)
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!closes(x, i)) continue;
    double sum = 0;
    for (std::int64_t k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(x.pattern.column[k]);
      if (!only_closing || closes(x, j)) sum += x.value[k] * v[j];
    }
    product[i] = sum;
  }
  return product;
}

class Newton {
 public:
  Newton(const ExchangeAreas& x, Values factor) : x_(x), factor_(std::move(factor)) {}

  /// None when it does not arrive.
  std::optional<Values> solve(int& sweeps) {
    double before = HUGE_VAL;
    for (int step = 0; step < most_newton_steps; ++step, ++sweeps) {
      stop_if_interrupted();
      rows();
      if (!std::isfinite(worst_)) return {};
      if (worst_ <= 0.1 * row_tolerance || (worst_ <= row_tolerance && worst_ >= 0.5 * before))
        return factor_;
      before = worst_;
      go(direction());
    }
    return {};
  }

 private:
  void rows() {
    row_ = times(x_, factor_, false);
    worst_ = 0;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      row_[i] *= factor_[i];
      if (closes(x_, i)) worst_ = std::max(worst_, std::abs(x_.area_m2[i] / row_[i] - 1));
    }
  }

  /// (I + S) y of the scaled Hessian diag(r) + f X f.
  Values hessian(const Values& y) const {
    Values v(y.size());
    for (std::size_t i = 0; i < y.size(); ++i)
      v[i] = closes(x_, i) ? factor_[i] * y[i] / std::sqrt(row_[i]) : 0;
    Values product = times(x_, v, true);
    for (std::size_t i = 0; i < y.size(); ++i)
      if (closes(x_, i)) product[i] = y[i] + factor_[i] * product[i] / std::sqrt(row_[i]);
    return product;
  }

  /// Of the logarithms.
  Values direction() const {
    constexpr int most_iterations = 400;
    constexpr double enough = 1e-12;
    Values left(row_.size(), 0);
    for (std::size_t i = 0; i < left.size(); ++i)
      if (closes(x_, i)) left[i] = (x_.area_m2[i] - row_[i]) / std::sqrt(row_[i]);
    Values y =
        conjugate_gradients(left, enough, most_iterations, [&](const Values& v) { return hessian(v); });
    for (std::size_t i = 0; i < y.size(); ++i)
      if (closes(x_, i)) y[i] /= std::sqrt(row_[i]);
    return y;
  }

  void go(const Values& way) {
    double longest = 0;
    for (const double w : way) longest = std::max(longest, std::abs(w));
    const double part = longest > 1 ? 1 / longest : 1;
    for (std::size_t i = 0; i < way.size(); ++i)
      if (closes(x_, i)) factor_[i] *= std::exp(part * way[i]);
  }

  const ExchangeAreas& x_;
  Values factor_, row_;
  double worst_ = 0;
};

}  // namespace

std::vector<double> balancing_factors(const ExchangeAreas& x, int& sweeps) {
  const std::size_t n = x.area_m2.size();
  Values factor(n, 1), ratio(n, 1);
  int newton_steps = 0;
  for (sweeps = 0; sweeps < most_sweeps; ++sweeps) {
    stop_if_interrupted();
    const Values sum = times(x, factor, false);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (closes(x, i)) ratio[i] = x.area_m2[i] / (factor[i] * sum[i]);
      worst = std::isfinite(ratio[i]) ? std::max(worst, std::abs(ratio[i] - 1)) : HUGE_VAL;
    }
    if (worst <= 0.1 * row_tolerance || (worst <= row_tolerance && sweeps > most_sweeps / 2)) return factor;
    if (!std::isfinite(worst)) break;
    if (sweeps == sweeps_before_newton)
      if (auto found = Newton(x, factor).solve(newton_steps)) {
        sweeps += newton_steps;
        return std::move(*found);
      }
    for (std::size_t i = 0; i < n; ++i) factor[i] *= std::sqrt(ratio[i]);
  }
  const auto worst = std::max_element(ratio.begin(), ratio.end(),
                                      [](double a, double b) { return std::abs(a - 1) < std::abs(b - 1); });
  throw NumericalError(
      fmt::format("closure: row {} stays {:.1e} away from its area after {} sweeps (it sees only "
                  "surfaces that cannot fill it: more rays, or another enclosure)",
                  worst - ratio.begin(), std::abs(*worst - 1), sweeps));
}

}  // namespace granrad
