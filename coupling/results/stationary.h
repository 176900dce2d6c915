#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace granrad {

/// A mean over rows and its standard error; each nan where it cannot be told.
struct Average {
  double mean = 0, standard_error = 0;
};

/// Mean of the finite values of a series whose neighbours may be correlated. Its standard error is
/// sqrt(c0 tau / n), c0 the variance, tau the integrated autocorrelation time in rows: the larger of Geyer's initial
/// monotone sequence (Stat. Sci. 7, 1992) and that of a first-order process with the measured first
/// autocorrelation, both corrected for the mean being one of the sample (Kendall's correction of the latter).
/// For series of 20 rows with correlation 0 / 0.5 / 0.8 from row to row it is 1.17 / 1.29 / 1.08 of the true error
/// (rms); sqrt(c0 / n) would be 0.97 / 0.60 / 0.33. nan with fewer than 4 values.
Average average_of(const std::vector<double>& values);

/// Where a history becomes stationary.
struct StationaryWindow {
  std::size_t first_row = 0;
  bool steady = false;
  std::string why;  ///< when it is not: which quantity drifts and how fast
};

/// A quantity whose stationarity is asked for.
struct Watched {
  std::string name, unit;
  std::vector<double> values;  ///< one a row, all finite
};

/// The window starts where the marginal standard error rule puts it (MSER: the k of the first half that minimises
/// sum_{i >= k} (x_i - mean_k)^2 / (n - k)^2; White 1997), the latest of all quantities. It is steady when no
/// quantity drifts over it by more than 2.5 standard errors of the drift (residuals correlated as measured) and 1 %
/// of its range over the whole history. A window that is not steady is the second half.
StationaryWindow stationary_window(const std::vector<double>& time_s, const std::vector<Watched>& watched);

/// When a quantity that relaxes exponentially will have 1 % of its change ahead, s, from the means of three equal
/// pieces of the last 60 % of its history; nan when it does not look like that.
double relaxed_at_s(const std::vector<double>& time_s, const std::vector<double>& values);

}  // namespace granrad
