#pragma once
#include <string>
#include <vector>

#include "fit/correlation/correlation.h"
#include "fit/fitting/samples.h"

namespace granrad {

struct FitOptions {
  CorrelationForm form = CorrelationForm::cubic;
  double pp_cutoff = 10;
  bool visible_only = false;       ///< leave out pairs no ray connected; the paper's table needs them in
  std::vector<std::string> walls;  ///< names of the walls to fit F_pw on; empty: those of the largest area
};

/// Samples within one interval of distance, for charts and for the scatter that no curve can beat.
struct DistanceBin {
  double distance = 0;  ///< mean
  std::size_t count = 0;
  double mean = 0;        ///< of F
  double fitted = 0;      ///< mean of the curve over the same samples
  double scatter2 = 0;    ///< variance of F about the curve's shape less that of the rays (may be negative)
  double mean_error = 0;  ///< standard error of `mean`
};

/// One curve fitted by unweighted least squares over every sample (zeros included, as the paper's table was).
struct CurveFit {
  std::vector<double> coefficient, standard_error;
  double samples = 0;
  double rmse = 0;           ///< of the samples about the curve
  double ray_noise = 0;      ///< part of it from the finite number of rays
  double scatter = 0;        ///< noise-free scatter about the mean at one distance
  double held_out_rmse = 0;  ///< each snapshot against the fit of the others; 0 with one snapshot
  std::vector<DistanceBin> bins;
};

/// What was fitted at one solid fraction.
struct RowFit {
  CorrelationRow row;
  CurveFit pp, pw;
  double wall_cutoff = 0;            ///< d*_pw up to which F_pw may be used: what the samples reached
  std::vector<std::string> origins;  ///< snapshots
};

/// Least squares (fit/fitting/least_squares.h) with its statistics. Standard errors are sqrt(diag((J^T J)^-1) SSR /
/// (n - p)): they take samples as independent, which pairs of one snapshot are not. Throws InputError when
/// there are fewer samples than coefficients, NumericalError when the fit fails.
CurveFit fit_pairs(const std::vector<const DistanceSamples*>& snapshots, CorrelationForm form);
CurveFit fit_walls(const std::vector<const DistanceSamples*>& snapshots, CorrelationForm form);

/// Fits one row to snapshots of one solid fraction (their mean, to four decimals), with its statistics and
/// the closure of its row sums.
RowFit fit_row(const std::vector<SampleSet>& snapshots, const FitOptions& options);

/// Splits snapshots into groups of one solid fraction (within 2 % of the first of its group, or 0.002),
/// ascending.
std::vector<std::vector<SampleSet>> grouped_by_solid_fraction(std::vector<SampleSet> snapshots);

/// Table of the rows, with conventions and validity range.
CorrelationTable make_table(const std::vector<RowFit>& rows, const FitOptions& options);

}  // namespace granrad
