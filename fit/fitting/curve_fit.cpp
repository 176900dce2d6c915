#include "fit/fitting/curve_fit.h"

#include <ceres/ceres.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr std::size_t most_parameters = 4;
using Parameters = std::array<double, most_parameters>;

std::size_t parameter_count(CurveForm form) {
  return form == CurveForm::exponential_logarithm ? 4 : 2;
}

/// In the parameters that are fitted (all but a power and an exponent enter linearly), with the derivatives by
/// them where `slope` is given.
double value(CurveForm form, const double* p, double x, double* slope = nullptr) {
  const auto with = [&](double y, std::initializer_list<double> by) {
    if (slope) std::copy(by.begin(), by.end(), slope);
    return y;
  };
  switch (form) {
    case CurveForm::power: {
      const double power = std::pow(x, p[1]);
      return with(p[0] * power, {power, p[0] * power * std::log(x)});
    }
    case CurveForm::line:
      return with(p[0] + p[1] * x, {1, x});
    case CurveForm::logarithm:
      return with(p[0] * std::log(x) + p[1], {std::log(x), 1});
    case CurveForm::exponential_logarithm:
      break;
  }
  const double grown = std::exp(p[1] * x);
  return with(p[0] * grown + p[2] * std::log(x) + p[3], {grown, p[0] * x * grown, std::log(x), 1});
}

class Residual : public ceres::CostFunction {
 public:
  Residual(CurveForm form, double x, double y) : form_(form), x_(x), y_(y) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameter_count(form)));
  }
  bool Evaluate(double const* const* parameters, double* residual, double** jacobians) const override {
    residual[0] = value(form_, parameters[0], x_, jacobians ? jacobians[0] : nullptr) - y_;
    return std::isfinite(residual[0]);  // a step too far is taken back
  }

 private:
  CurveForm form_;
  double x_, y_;
};

double squares(CurveForm form, const Parameters& p, const std::vector<double>& x,
               const std::vector<double>& y) {
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += std::pow(value(form, p.data(), x[k]) - y[k], 2);
  return sum;
}

void add_residuals(ceres::Problem& problem, CurveForm form, const std::vector<double>& x,
                   const std::vector<double>& y, double* p) {
  for (std::size_t k = 0; k < x.size(); ++k)
    problem.AddResidualBlock(new Residual(form, x[k], y[k]), nullptr, p);
}

/// The best of several starts: the exponent alone decides where the sum of squares has a second minimum.
Parameters solve(CurveForm form, const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Parameters> starts = {{1, 1, 0, 0}};
  const double longest = *std::max_element(x.begin(), x.end());
  if (form == CurveForm::exponential_logarithm) {
    starts.clear();
    for (double b : {-8.0, -4.0, -2.0, -1.0, 1.0, 2.0, 4.0, 8.0})
      starts.push_back({0.1, b / longest, 0.5, 1});
  }
  Parameters best = starts.front();
  double least = infinity;
  for (auto p : starts) {
    ceres::Problem problem;
    add_residuals(problem, form, x, y, p.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 2000;
    options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-14;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) continue;
    if (const double sum = squares(form, p, x, y); sum < least) least = sum, best = p;
  }
  if (!std::isfinite(least)) throw NumericalError("fit: no start leads to a curve through these points");
  return best;
}

/// Covariance of the parameters, p x p by rows.
std::vector<double> covariance(CurveForm form, const std::vector<double>& x, const std::vector<double>& y,
                               Parameters p) {
  const std::size_t n = parameter_count(form);
  ceres::Problem problem;
  add_residuals(problem, form, x, y, p.data());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance estimate(options);
  const std::vector<std::pair<const double*, const double*>> blocks = {{p.data(), p.data()}};
  if (!estimate.Compute(blocks, &problem))
    throw NumericalError(advised("fit: the points do not determine the coefficients", "take more points"));
  std::vector<double> result(n * n);
  estimate.GetCovarianceBlock(p.data(), p.data(), result.data());
  const double variance = squares(form, p, x, y) / static_cast<double>(x.size() - n);
  for (double& one : result) one *= variance;
  return result;
}

/// The offset c' = a ln b of a logarithm becomes its factor b, at positions `factor` and `offset`.
void to_factor(std::vector<double>& p, std::vector<double>& error, const std::vector<double>& cov,
               std::size_t factor, std::size_t offset) {
  const std::size_t n = p.size();
  const double a = p[factor], c = p[offset], b = std::exp(c / a);
  const double by_offset = b / a, by_factor = -b * c / (a * a);
  p[offset] = b;
  error[offset] = std::sqrt(std::max(0.0, by_offset * by_offset * cov[offset * n + offset] +
                                              by_factor * by_factor * cov[factor * n + factor] +
                                              2 * by_offset * by_factor * cov[offset * n + factor]));
}

void check(CurveForm form, const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size() || x.size() <= parameter_count(form))
    throw InputError(
        fmt::format("fit: {} points (the curve has {} coefficients and needs more points than that)",
                    x.size(), parameter_count(form)));
  for (std::size_t k = 0; k < x.size(); ++k)
    if (!std::isfinite(x[k]) || !std::isfinite(y[k]) || (form != CurveForm::line && x[k] <= 0))
      throw InputError(fmt::format("fit: point {}: x = {}, y = {} ({})", k + 1, x[k], y[k],
                                   form == CurveForm::line ? "must be finite" : "must be finite, and x > 0"));
}

}  // namespace

CurveForm curve_form(const std::string& name) {
  if (name == "power") return CurveForm::power;
  if (name == "line") return CurveForm::line;
  if (name == "logarithm") return CurveForm::logarithm;
  if (name == "exponential_logarithm") return CurveForm::exponential_logarithm;
  throw InputError(fmt::format("form = {} (must be power, line, logarithm or exponential_logarithm)", name));
}

DataCurve fit_curve(CurveForm form, const std::vector<double>& x, const std::vector<double>& y) {
  check(form, x, y);
  const std::size_t n = parameter_count(form);
  const Parameters best = solve(form, x, y);
  const auto cov = covariance(form, x, y, best);
  DataCurve fit{form, {best.begin(), best.begin() + static_cast<long>(n)}, {}, 0, 0, x.size()};
  for (std::size_t k = 0; k < n; ++k) fit.standard_error.push_back(std::sqrt(cov[k * n + k]));
  const double sum = squares(form, best, x, y);
  if (form == CurveForm::logarithm) to_factor(fit.coefficient, fit.standard_error, cov, 0, 1);
  if (form == CurveForm::exponential_logarithm) to_factor(fit.coefficient, fit.standard_error, cov, 2, 3);
  double mean = 0, total = 0;
  for (double one : y) mean += one / static_cast<double>(y.size());
  for (double one : y) total += (one - mean) * (one - mean);
  fit.r_squared = total > 0 ? 1 - sum / total : 1;
  fit.rmse = std::sqrt(sum / static_cast<double>(y.size()));
  return fit;
}

std::string curve_formula(const DataCurve& fit) {
  const auto& c = fit.coefficient;
  switch (fit.form) {
    case CurveForm::power:
      return fmt::format("{:.6g} * x^({:.6g})", c[0], c[1]);
    case CurveForm::line:
      return fmt::format("{:.6g} + {:.6g} * x", c[0], c[1]);
    case CurveForm::logarithm:
      return fmt::format("{:.6g} * ln({:.6g} * x)", c[0], c[1]);
    case CurveForm::exponential_logarithm:
      break;
  }
  return fmt::format("{:.6g} * exp({:.6g} * x) + {:.6g} * ln({:.6g} * x)", c[0], c[1], c[2], c[3]);
}

}  // namespace granrad
