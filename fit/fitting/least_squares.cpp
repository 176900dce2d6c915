#include "fit/fitting/least_squares.h"

#include <ceres/ceres.h>
#include <fmt/core.h>

#include <Eigen/Dense>
#include <cmath>

#include "dem/base/error.h"
#include "fit/fitting/student.h"

namespace granrad {

namespace {

using Snapshots = std::vector<const DistanceSamples*>;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t block_samples = 8192;

/// [J r] rotated to p + 1 rows: |J x + r|^2 = |R x + q|^2 + rest^2 for every x.
struct Reduced {
  Matrix r;  ///< [p, p] upper triangle
  Vector q;
  double rest = 0;
  double squares() const { return q.squaredNorm() + rest * rest; }
};

/// Upper triangle of the QR factorisation of a matrix of at least as many rows as columns.
Matrix triangle(const Matrix& rows) {
  const Eigen::Index columns = rows.cols();
  Matrix padded = rows;
  if (rows.rows() < columns) {
    padded = Matrix::Zero(columns, columns);
    padded.topRows(rows.rows()) = rows;
  }
  return Eigen::HouseholderQR<Matrix>(padded).matrixQR().topRows(columns).triangularView<Eigen::Upper>();
}

Reduced reduced(const Matrix& top) {
  const Eigen::Index p = top.cols() - 1;
  return {top.topLeftCorner(p, p), top.col(p).head(p), top(p, p)};
}

Matrix stacked(const std::vector<Matrix>& parts) {
  const Eigen::Index columns = parts.front().cols();
  Matrix all(columns * static_cast<Eigen::Index>(parts.size()), columns);
  for (std::size_t k = 0; k < parts.size(); ++k)
    all.middleRows(static_cast<Eigen::Index>(k) * columns, columns) = parts[k];
  return all;
}

/// A curve's problem in its fitted parameters.
class Problem {
 public:
  Problem(const Curve& curve, const Snapshots& snapshots)
      : curve_(curve), snapshots_(snapshots), logarithms_(fitted_as_logarithms(curve.form)) {}

  std::size_t size() const { return curve_.size(); }
  std::vector<double> coefficients(const double* parameter) const {
    std::vector<double> c(parameter, parameter + size());
    if (logarithms_)
      for (double& v : c) v = std::exp(v);
    return c;
  }
  std::vector<double> parameters(std::vector<double> coefficient) const {
    if (logarithms_)
      for (double& v : coefficient) v = std::log(v);
    return coefficient;
  }
  /// d coefficient / d parameter.
  double slope(double coefficient) const { return logarithms_ ? coefficient : 1; }

  /// The upper triangle of [J r] of one snapshot.
  Matrix snapshot_triangle(const DistanceSamples& samples, const std::vector<double>& coefficient) const {
    const std::size_t blocks = (samples.size() + block_samples - 1) / block_samples;
    std::vector<Matrix> parts(std::max<std::size_t>(1, blocks));
    if (blocks == 0) parts[0] = Matrix::Zero(columns(), columns());
#pragma omp parallel for schedule(dynamic, 4)
    for (std::size_t b = 0; b < blocks; ++b)
      parts[b] = triangle(
          block(samples, coefficient, b * block_samples, std::min(samples.size(), (b + 1) * block_samples)));
    return parts.size() == 1 ? parts[0] : triangle(stacked(parts));
  }

  std::vector<Matrix> triangles(const double* parameter) const {
    const auto coefficient = coefficients(parameter);
    std::vector<Matrix> all;
    for (const auto* samples : snapshots_) all.push_back(snapshot_triangle(*samples, coefficient));
    return all;
  }

 private:
  Eigen::Index columns() const {
    return static_cast<Eigen::Index>(size()) + 1;
  }

  Matrix block(const DistanceSamples& samples, const std::vector<double>& coefficient, std::size_t first,
               std::size_t last) const {
    const std::size_t p = size();
    Matrix rows(static_cast<Eigen::Index>(last - first), columns());
    double derivative[most_coefficients];
    for (std::size_t k = first; k < last; ++k) {
      const auto row = static_cast<Eigen::Index>(k - first);
      const double f =
          curve_.value(coefficient.data(), samples.distance[k], samples.unobstructed[k], derivative);
      for (std::size_t c = 0; c < p; ++c)
        rows(row, static_cast<Eigen::Index>(c)) = derivative[c] * slope(coefficient[c]);
      rows(row, static_cast<Eigen::Index>(p)) = f - samples.factor[k];
    }
    return rows;
  }

  const Curve& curve_;
  const Snapshots& snapshots_;
  bool logarithms_;
};

/// The reduced problem as Ceres sees it: p + 1 residuals.
class ReducedCost : public ceres::CostFunction {
 public:
  explicit ReducedCost(const Problem& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.size()) + 1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto now = reduced(triangle(stacked(problem_.triangles(parameters[0]))));
    const Eigen::Index p = now.q.size();
    if (!now.q.allFinite() || !std::isfinite(now.rest)) return false;
    Eigen::Map<Vector>(residuals, p) = now.q;
    residuals[p] = now.rest;
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> j(jacobians[0], p + 1,
                                                                                         p);
    j.topRows(p) = now.r;
    j.row(p).setZero();
    return true;
  }

 private:
  const Problem& problem_;
};

ceres::Solver::Options solver_options(bool linear) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-10;
  if (linear) options.initial_trust_region_radius = 1e16;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

void require_samples(const Curve& curve, const Snapshots& snapshots) {
  std::size_t n = 0;
  for (const auto* s : snapshots)
    for (std::size_t k = 0; k < s->size(); ++k, ++n)
      if (!std::isfinite(s->distance[k]) || !std::isfinite(s->factor[k]) ||
          !std::isfinite(s->unobstructed[k]))
        throw InputError(advised(
            fmt::format("sample {}: distance = {}, F = {} (not finite)", k, s->distance[k], s->factor[k]),
            "trace the snapshot again"));
  if (n <= curve.size())
    throw InputError(advised(
        fmt::format("fit: {} samples (the {} form has {} coefficients for {})", n, to_string(curve.form),
                    curve.size(), curve.partner == Partner::wall ? "walls" : "pairs"),
        "trace a larger bed"));
}

/// R of all samples. Throws NumericalError when it is singular.
Matrix determined(const Reduced& all) {
  const Vector scale = all.r.colwise().norm();
  const std::string advice = "spread them over more distances";
  if (!(scale.minCoeff() > 0))
    throw NumericalError(advised("fit: the samples do not depend on every coefficient", advice));
  const Matrix unit = all.r * scale.cwiseInverse().asDiagonal();
  const auto values = Eigen::JacobiSVD<Matrix>(unit).singularValues();
  if (values.minCoeff() < 1e-6 * values.maxCoeff())
    throw NumericalError(advised("fit: the samples do not determine the coefficients", advice));
  return all.r;
}

/// Of the parameters.
Vector standard_errors(const std::vector<Matrix>& triangles, const Reduced& all, std::size_t samples) {
  const Eigen::Index p = all.q.size();
  const Matrix inverse = determined(all).triangularView<Eigen::Upper>().solve(Matrix::Identity(p, p));
  const Matrix bread = inverse * inverse.transpose();
  const double snapshots = static_cast<double>(triangles.size());
  if (triangles.size() < 2)
    return (bread.diagonal() * all.squares() / (static_cast<double>(samples) - static_cast<double>(p)))
        .cwiseSqrt();
  Matrix meat = Matrix::Zero(p, p);
  for (const Matrix& triangle : triangles) {
    const auto one = reduced(triangle);
    const Vector score = one.r.transpose() * one.q;
    meat += score * score.transpose();
  }
  const Matrix variance = bread * (meat * snapshots / (snapshots - 1)) * bread;
  return student_widening(triangles.size()) * variance.diagonal().cwiseSqrt();
}

}  // namespace

FittedCoefficients least_squares(const Curve& curve, const Snapshots& snapshots,
                                 const std::vector<double>& start) {
  require_samples(curve, snapshots);
  std::size_t n = 0;
  for (const auto* s : snapshots) n += s->size();
  const Problem problem(curve, snapshots);
  auto parameter = problem.parameters(start.empty() ? first_guess(curve.form, curve.partner) : start);
  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new ReducedCost(problem), nullptr, parameter.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(!fitted_as_logarithms(curve.form)), &ceres_problem, &summary);
  if (!summary.IsSolutionUsable() || summary.termination_type == ceres::NO_CONVERGENCE)
    throw NumericalError(
        fmt::format("fit of the {} form to {} samples: {}", to_string(curve.form), n, summary.message));
  const auto near = reduced(triangle(stacked(problem.triangles(parameter.data()))));
  const Vector step = determined(near).triangularView<Eigen::Upper>().solve(near.q);
  for (std::size_t k = 0; k < parameter.size(); ++k) parameter[k] -= step[static_cast<Eigen::Index>(k)];

  const auto triangles = problem.triangles(parameter.data());
  const auto all = reduced(triangle(stacked(triangles)));
  const Vector error = standard_errors(triangles, all, n);
  FittedCoefficients result;
  result.coefficient = problem.coefficients(parameter.data());
  for (std::size_t k = 0; k < parameter.size(); ++k)
    result.standard_error.push_back(error[static_cast<Eigen::Index>(k)] *
                                    problem.slope(result.coefficient[k]));
  result.squares = all.squares();
  return result;
}

}  // namespace granrad
