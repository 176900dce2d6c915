#include "coupling/results/stationary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/base/constants.h"

namespace granrad {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t fewest_rows = 4;
constexpr double drift_in_errors = 2.5, drift_of_range = 0.01;

double mean_of(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += x[k];
  return end > begin ? sum / static_cast<double>(end - begin) : undefined;
}

std::vector<double> without_mean(const std::vector<double>& values) {
  const double mean = mean_of(values, 0, values.size());
  auto deviations = values;
  for (double& d : deviations) d -= mean;
  return deviations;
}

/// sum d_i d_{i+lag} / n
double autocovariance(const std::vector<double>& d, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < d.size(); ++i) sum += d[i] * d[i + lag];
  return sum / static_cast<double>(d.size());
}

/// c0 tau of Geyer's initial monotone sequence.
double summed_monotone(const std::vector<double>& d, double c0) {
  const double n = static_cast<double>(d.size());
  double sum = -c0, last_pair = infinity;
  for (std::size_t lag = 0; lag + 1 < d.size(); lag += 2) {
    const double pair = std::min(autocovariance(d, lag) + autocovariance(d, lag + 1), last_pair);
    if (pair <= 0) break;
    sum += 2 * pair;
    last_pair = pair;
  }
  sum = std::max(sum, c0 / n);
  return sum / std::max(1 - sum / (c0 * n), 0.1);  // the mean of the sample follows its slow part
}

/// c0 tau of a first-order process.
double summed_first_order(const std::vector<double>& d, double c0) {
  const double n = static_cast<double>(d.size()), measured = autocovariance(d, 1) / c0;
  const double rho = std::clamp(measured + (1 + 3 * measured) / n, 0.0, 0.99);
  const double tau = std::min((1 + rho) / (1 - rho), n / 2);
  return c0 * tau * n / (n - tau);
}

/// Variance of the mean of correlated deviations.
double variance_of_mean(const std::vector<double>& deviations) {
  const double c0 = autocovariance(deviations, 0);
  if (!(c0 > 0)) return 0;
  return std::max(summed_monotone(deviations, c0), summed_first_order(deviations, c0)) /
         static_cast<double>(deviations.size());
}

/// The row at which the marginal standard error of what follows is smallest.
std::size_t mser_row(const std::vector<double>& x) {
  const double offset = mean_of(x, 0, x.size());  // keeps digits in the sums of squares
  double sum = 0, squares = 0, smallest = infinity;
  std::size_t best = 0;
  for (std::size_t k = x.size(); k-- > 0;) {
    const double d = x[k] - offset, count = static_cast<double>(x.size() - k);
    sum += d;
    squares += d * d;
    const double z = (squares - sum * sum / count) / (count * count);
    if (k <= x.size() / 2 && z <= smallest) smallest = z, best = k;
  }
  return best;
}

/// Neighbours averaged until few enough are left for sums over all lags; correlations longer than that stay.
std::vector<double> few(std::vector<double> values) {
  constexpr std::size_t most = 4000;
  while (values.size() > most) {
    for (std::size_t k = 0; 2 * k + 1 < values.size(); ++k)
      values[k] = (values[2 * k] + values[2 * k + 1]) / 2;
    values.resize(values.size() / 2);
  }
  return values;
}

/// A straight line through the rows from `first` on.
struct Drift {
  double slope = 0, over_window = 0, error_over_window = 0;
};

Drift drift_of(const std::vector<double>& time, const std::vector<double>& x, std::size_t first) {
  const double n = static_cast<double>(x.size() - first), middle = mean_of(time, first, x.size()),
               mean = mean_of(x, first, x.size());
  double tt = 0, tx = 0;
  for (std::size_t k = first; k < x.size(); ++k) {
    tt += (time[k] - middle) * (time[k] - middle);
    tx += (time[k] - middle) * (x[k] - mean);
  }
  if (!(tt > 0)) return {};
  Drift drift;
  drift.slope = tx / tt;
  std::vector<double> residuals;
  for (std::size_t k = first; k < x.size(); ++k)
    residuals.push_back(x[k] - mean - drift.slope * (time[k] - middle));
  const double length = time.back() - time[first];
  drift.over_window = drift.slope * length;
  drift.error_over_window = length * std::sqrt(variance_of_mean(without_mean(few(residuals))) * n / tt);
  return drift;
}

double range_of(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

}  // namespace

Average average_of(const std::vector<double>& values) {
  std::vector<double> defined;
  for (double value : values)
    if (std::isfinite(value)) defined.push_back(value);
  Average result{mean_of(defined, 0, defined.size()), undefined};
  if (defined.size() >= fewest_rows)
    result.standard_error = std::sqrt(variance_of_mean(without_mean(few(defined))));
  return result;
}

StationaryWindow stationary_window(const std::vector<double>& time_s, const std::vector<Watched>& watched) {
  StationaryWindow window;
  const std::size_t rows = time_s.size();
  for (const auto& one : watched) window.first_row = std::max(window.first_row, mser_row(one.values));
  if (rows - window.first_row < fewest_rows) {
    window.why = fmt::format("{} rows are too few to tell", rows);
    window.first_row = rows / 2;
    return window;
  }
  for (const auto& one : watched) {
    const Drift drift = drift_of(time_s, one.values, window.first_row);
    const double allowed =
        std::max({drift_in_errors * drift.error_over_window, drift_of_range * range_of(one.values),
                  1e-9 * std::abs(one.values.back())});
    if (std::abs(drift.over_window) > allowed && window.why.empty())
      window.why = fmt::format("{} {} {:.3g} {}/s", one.name, drift.slope > 0 ? "rises" : "falls",
                               std::abs(drift.slope), one.unit);
  }
  window.steady = window.why.empty();
  if (!window.steady) window.first_row = rows / 2;
  return window;
}

double relaxed_at_s(const std::vector<double>& time_s, const std::vector<double>& values) {
  const std::size_t n = values.size(), piece = n / 5;
  if (piece < 1) return undefined;
  const double a = mean_of(values, n - 3 * piece, n - 2 * piece),
               b = mean_of(values, n - 2 * piece, n - piece), c = mean_of(values, n - piece, n);
  const double ratio = (c - b) / (b - a);
  if (!(ratio > 0 && ratio < 0.95)) return undefined;
  const double spacing = time_s[n - 1] - time_s[n - 1 - piece], constant = -spacing / std::log(ratio);
  const double ahead = std::abs((c - b) * ratio / (1 - ratio)), change = range_of(values) + ahead;
  return time_s.back() - spacing / 2 + constant * std::max(0.0, std::log(ahead / (drift_of_range * change)));
}

}  // namespace granrad
