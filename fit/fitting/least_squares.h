#pragma once
#include <vector>

#include "fit/fitting/curve.h"
#include "fit/fitting/samples.h"

namespace granrad {

struct FittedCoefficients {
  std::vector<double> coefficient;
  /// By the scatter between snapshots, see below; +- 1.96 of it cover 95 %.
  std::vector<double> standard_error;
  double squares = 0;  ///< sum of squared residuals
};

/// Unweighted least squares of a curve through every sample of some snapshots, by Ceres (the only user of
/// ceres.h). Ceres sees the reduced problem: at each trial the residuals of all samples, however many, are
/// rotated block by block (Householder QR) into as many rows as there are coefficients, which has the same
/// steps and the same minimum; a last Gauss-Newton step takes the solution to round-off. Coefficients that
/// must be positive are fitted as logarithms. The same samples give the same bits for any number of threads.
///
/// Standard errors: samples of one snapshot share its particles and are not independent, snapshots are. With
/// J the Jacobian, r the residuals and g = 1 .. G the snapshots,
///     V = (J^T J)^-1 [ G/(G-1) sum_g (J_g^T r_g)(J_g^T r_g)^T ] (J^T J)^-1
/// (Liang and Zeger 1986), times the squared ratio of Student's quantile t(0.975; G - 1) to 1.96, because G is
/// small. With one snapshot sqrt(diag((J^T J)^-1) SSR / (n - p)) is all there is; it is 2.6 to 10 times too
/// small at solid fractions of 0.25 and more.
///
/// `start`: coefficients to start from; empty: the form's own. Throws InputError with fewer samples than
/// coefficients or samples that are not finite, NumericalError when Ceres fails or the samples do not
/// determine the coefficients.
FittedCoefficients least_squares(const Curve& curve, const std::vector<const DistanceSamples*>& snapshots,
                                 const std::vector<double>& start = {});

}  // namespace granrad
