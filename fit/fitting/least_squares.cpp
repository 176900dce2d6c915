#include "fit/fitting/least_squares.h"

#include <ceres/ceres.h>
#include <fmt/core.h>

#include <Eigen/Dense>
#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr std::size_t most_samples = 4000000, block_samples = 8192;

/// The samples in use, contiguous.
struct Data {
  std::vector<double> distance, unobstructed, factor;
};

Data gather(const std::vector<const DistanceSamples*>& snapshots) {
  std::size_t total = 0;
  for (const auto* s : snapshots) total += s->size();
  const std::size_t every = (total + most_samples - 1) / most_samples;
  Data data;
  std::size_t at = 0;
  for (const auto* s : snapshots)
    for (std::size_t k = 0; k < s->size(); ++k) {
      if (at++ % every != 0) continue;
      if (!std::isfinite(s->distance[k]) || !std::isfinite(s->factor[k]) ||
          !std::isfinite(s->unobstructed[k]))
        throw InputError(fmt::format("sample {}: distance = {}, F = {} (not finite) trace the snapshot again",
                                     k, s->distance[k], s->factor[k]));
      data.distance.push_back(s->distance[k]);
      data.unobstructed.push_back(s->unobstructed[k]);
      data.factor.push_back(s->factor[k]);
    }
  return data;
}

/// Residuals curve - F of samples [first, last).
class BlockResiduals : public ceres::CostFunction {
 public:
  BlockResiduals(const Curve& curve, const Data& data, std::size_t first, std::size_t last)
      : curve_(curve), data_(data), first_(first), last_(last) {
    set_num_residuals(static_cast<int>(last - first));
    mutable_parameter_block_sizes()->push_back(curve.parameters());
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    double* row = jacobians ? jacobians[0] : nullptr;
    for (std::size_t k = first_; k < last_; ++k) {
      const double f = curve_.value(parameters[0], data_.distance[k], data_.unobstructed[k], row);
      *residuals++ = f - data_.factor[k];
      if (row) row += curve_.parameters();
    }
    return true;
  }

 private:
  const Curve& curve_;
  const Data& data_;
  std::size_t first_, last_;
};

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

/// sqrt(diag((J^T J)^-1) SSR / (n - p)).
std::vector<double> standard_errors(const Curve& curve, const Data& data,
                                    const std::vector<double>& parameter) {
  const int p = curve.parameters();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd row(p);
  double squares = 0;
  for (std::size_t k = 0; k < data.factor.size(); ++k) {
    const double f = curve.value(parameter.data(), data.distance[k], data.unobstructed[k], row.data());
    squares += (f - data.factor[k]) * (f - data.factor[k]);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  normal = normal.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0))
    throw NumericalError(
        "fit: the samples do not depend on every coefficient (spread them over more distances)");
  const Eigen::MatrixXd unit = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit).eigenvalues();
  if (eigenvalues.minCoeff() < 1e-13 * eigenvalues.maxCoeff())
    throw NumericalError(
        "fit: the samples do not determine the coefficients (spread them over more distances)");
  const Eigen::MatrixXd inverse = unit.inverse();
  const double variance = squares / static_cast<double>(data.factor.size() - static_cast<std::size_t>(p));
  std::vector<double> errors;
  for (int k = 0; k < p; ++k) errors.push_back(std::sqrt(variance * inverse(k, k)) / scale[k]);
  return errors;
}

}  // namespace

CurveParameters least_squares(const Curve& curve, const std::vector<const DistanceSamples*>& snapshots) {
  const Data data = gather(snapshots);
  const std::size_t n = data.factor.size();
  if (n <= static_cast<std::size_t>(curve.parameters()))
    throw InputError(
        fmt::format("fit: {} samples (the {} form has {} coefficients for {}) trace a larger bed", n,
                    to_string(curve.form), curve.parameters(), curve.wall ? "walls" : "pairs"));
  CurveParameters result;
  result.parameter = curve.start();
  ceres::Problem problem;
  for (std::size_t first = 0; first < n; first += block_samples)
    problem.AddResidualBlock(new BlockResiduals(curve, data, first, std::min(n, first + block_samples)),
                             nullptr, result.parameter.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  if (!summary.IsSolutionUsable() || summary.termination_type == ceres::NO_CONVERGENCE)
    throw NumericalError(
        fmt::format("fit of the {} form to {} samples: {}", to_string(curve.form), n, summary.message));
  result.standard_error = standard_errors(curve, data, result.parameter);
  return result;
}

}  // namespace granrad
