#pragma once
#include <string>
#include <vector>

#include "fit/correlation/correlation.h"
#include "fit/fitting/samples.h"

namespace granrad {

struct FitOptions {
  CorrelationForm form = CorrelationForm::cubic;
  double pp_cutoff = 10;
  bool visible_only = false;  ///< leave out pairs no ray connected; the paper's table needs them in
  /// Names of the walls to fit F_pw on; empty: those of the largest area; "all": every planar wall.
  std::vector<std::string> walls;
  WallDistance pw_distance = WallDistance::centre_to_plane_over_d;
  double pw_reach = largest_pw_cutoff;  ///< samples of walls farther than this h/d are left out
};

/// As the paper fitted its table: cubics, all pairs with zeros out to d* = 20, F_pw over all six walls against
/// (h + r)/d, out to h = 20 d.
FitOptions paper_choices();

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
  double left_out_rmse = 0;  ///< against the table without this row; 0 for the first and last
  std::vector<DistanceBin> bins;
};

/// What was fitted at one solid fraction.
struct RowFit {
  CorrelationRow row;
  CurveFit pp, pw;
  double wall_cutoff = 0;            ///< d*_pw up to which F_pw may be used: what the samples reached
  std::vector<std::string> origins;  ///< snapshots
};

/// Least squares with its statistics and the errors of its coefficients (fit/fitting/least_squares.h). Throws
/// InputError when there are fewer samples than coefficients, NumericalError when the fit fails.
CurveFit fit_pairs(const std::vector<const DistanceSamples*>& snapshots, CorrelationForm form);
CurveFit fit_walls(const std::vector<const DistanceSamples*>& snapshots, CorrelationForm form,
                   WallDistance pw_distance = WallDistance::centre_to_plane_over_d);

/// Fits one row to snapshots of one solid fraction (their mean, to four decimals), with its statistics and
/// the closure of its row sums.
RowFit fit_row(const std::vector<SampleSet>& snapshots, const FitOptions& options);

/// The samples of a snapshot that a fit with these options uses: pairs, and walls as one.
struct FittedSamples {
  DistanceSamples pairs, walls;
};
FittedSamples fitted_samples(const SampleSet& set, const FitOptions& options);

/// Splits snapshots into groups of one solid fraction (within 2 % of the first of its group, or 0.002),
/// ascending: numbers of the snapshots.
std::vector<std::vector<std::size_t>> grouped_by_solid_fraction(const std::vector<double>& solid_fraction);

/// Table of the rows, with conventions and validity range.
CorrelationTable make_table(const std::vector<RowFit>& rows, const FitOptions& options);

}  // namespace granrad
