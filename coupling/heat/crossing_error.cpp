#include "coupling/heat/crossing_error.h"

#include <cmath>
#include <numeric>

#include "raytrace/balancing.h"
#include "raytrace/conjugate_gradients.h"

namespace granrad {

namespace {

using Values = std::vector<double>;

/// What of sums over pairs closure takes back, by row: (diag(A) + X) c = t by conjugate gradients.
class ClosureShift {
 public:
  ClosureShift(const ExchangeAreas& areas, const Values& j, const Values& a) : x_(areas) {
    Values t(j.size(), 0);
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (!closes(x_, i)) continue;
      for (auto k = x_.pattern.row_begin[i]; k < x_.pattern.row_begin[i + 1]; ++k) {
        const auto n = static_cast<std::size_t>(x_.pattern.column[k]);
        t[i] += x_.value[k] * (j[i] - j[n]) * (a[i] - a[n]);
      }
      t[i] /= std::sqrt(x_.area_m2[i]);
    }
    solve(t);
  }
  const Values& values() const { return c_; }

 private:
  /// (I + A^-1/2 X A^-1/2) y.
  Values applied(const Values& y) const {
    Values product(y.size(), 0);
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (!closes(x_, i)) continue;
      double sum = 0;
      for (auto k = x_.pattern.row_begin[i]; k < x_.pattern.row_begin[i + 1]; ++k) {
        const auto n = static_cast<std::size_t>(x_.pattern.column[k]);
        if (closes(x_, n)) sum += x_.value[k] * y[n] / std::sqrt(x_.area_m2[n]);
      }
      product[i] = y[i] + sum / std::sqrt(x_.area_m2[i]);
    }
    return product;
  }
  void solve(const Values& right) {
    constexpr int most_iterations = 300;
    constexpr double enough = 1e-6;  // an error is wanted, not a heat
    c_ = conjugate_gradients(right, enough, most_iterations, [&](const Values& y) { return applied(y); });
    for (std::size_t i = 0; i < c_.size(); ++i)
      if (closes(x_, i)) c_[i] /= std::sqrt(x_.area_m2[i]);
  }

  const ExchangeAreas& x_;
  Values c_;
};

}  // namespace

double crossing_error_W(const ExchangeAreas& areas, const ReplicateSamples& replicates,
                        const Values& radiosity_W_m2, const Values& adjoint) {
  const ClosureShift shift(areas, radiosity_W_m2, adjoint);
  const Values& c = shift.values();
  Values found;
  for (const auto& replicate : replicates) {
    double sum = 0;
    for (const auto& [i, j, x] : replicate)
      sum += ((radiosity_W_m2[i] - radiosity_W_m2[j]) * (adjoint[i] - adjoint[j]) - c[i] - c[j]) * x;
    found.push_back(sum);
  }
  const double n = static_cast<double>(found.size());
  const double mean = std::accumulate(found.begin(), found.end(), 0.0) / n;
  double squares = 0;
  for (const double q : found) squares += (q - mean) * (q - mean);
  return std::sqrt(squares / (n * (n - 1)));
}

}  // namespace granrad
