#pragma once
#include <vector>

#include "fit/fitting/curve.h"
#include "fit/fitting/samples.h"

namespace granrad {

struct CurveParameters {
  std::vector<double> parameter, standard_error;
};

/// Unweighted least squares of a curve through samples, by Ceres (the only user of ceres.h): Levenberg-
/// Marquardt on every residual, in blocks; of more than 4e6 samples every k-th. One thread, so that the same
/// samples give the same bits. Throws InputError with fewer samples than parameters or samples that are not
/// finite, NumericalError when Ceres fails or the samples do not determine the parameters.
CurveParameters least_squares(const Curve& curve, const std::vector<const DistanceSamples*>& snapshots);

}  // namespace granrad
