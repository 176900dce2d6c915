#include "coupling/heat/radiosity.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {
struct ExchangeOperator;
}
template <>
struct Eigen::internal::traits<granrad::ExchangeOperator> : traits<SparseMatrix<double>> {};

namespace granrad {

using Vector = Eigen::VectorXd;

/// I - diag(left) X diag(right), applied row by row in a fixed order and never formed.
struct ExchangeOperator : Eigen::EigenBase<ExchangeOperator> {
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  const ExchangeAreas& areas;
  Vector left, right;

  ExchangeOperator(const ExchangeAreas& x, Vector l, Vector r)
      : areas(x), left(std::move(l)), right(std::move(r)) {}
  Eigen::Index rows() const { return left.size(); }
  Eigen::Index cols() const { return left.size(); }
  template <class Rhs>
  Eigen::Product<ExchangeOperator, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }
};

namespace {

/// Surfaces from which on threads pay.
constexpr Eigen::Index many = 500;

Vector multiply(const ExchangeAreas& areas, const Vector& x) {
  const auto& row = areas.pattern.row_begin;
  Vector y(x.size());
#pragma omp parallel for schedule(static) if (x.size() >= many)
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double sum = 0;
    for (auto k = row[i]; k < row[i + 1]; ++k) sum += areas.value[k] * x[areas.pattern.column[k]];
    y[i] = sum;
  }
  return y;
}

}  // namespace
}  // namespace granrad

template <class Rhs>
struct Eigen::internal::generic_product_impl<granrad::ExchangeOperator, Rhs, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : generic_product_impl_base<granrad::ExchangeOperator, Rhs,
                                generic_product_impl<granrad::ExchangeOperator, Rhs>> {
  template <class Destination>
  static void scaleAndAddTo(Destination& out, const granrad::ExchangeOperator& op, const Rhs& x,
                            const double& scale) {
    const Eigen::Ref<const granrad::Vector> in(x);
    out += scale * (in - op.left.cwiseProduct(granrad::multiply(op.areas, op.right.cwiseProduct(in))));
  }
};

namespace granrad {
namespace {

/// Every X_ij stands beside an equal X_ji. One pass: the entries of column i appear in ascending rows.
bool is_symmetric(const ExchangeAreas& areas) {
  const auto& [row, column] = areas.pattern;
  auto next = row;  // first entry of each row whose mirror image was not met yet
  for (std::size_t i = 0; i + 1 < row.size(); ++i)
    for (auto k = row[i]; k < row[i + 1]; ++k) {
      const auto j = column[k];
      if (next[j] == row[j + 1] || column[next[j]] != static_cast<std::int32_t>(i) ||
          areas.value[next[j]] != areas.value[k])
        return false;
      ++next[j];
    }
  return true;
}

/// Residuals: aimed at, and the largest that is still an answer.
constexpr double target_residual = 1e-14, accepted_residual = 1e-10;

template <class Solver>
Vector solve(const ExchangeOperator& op, const Vector& rhs, RadiosityResult& result) {
  Solver solver;
  solver.setTolerance(target_residual);
  solver.setMaxIterations(20000);
  solver.compute(op);
  const Vector x = solver.solve(rhs);
  result.iterations = static_cast<int>(solver.iterations());
  result.relative_residual = rhs.norm() > 0 ? solver.error() : 0;
  if (!(result.relative_residual <= accepted_residual) || !x.allFinite())
    throw NumericalError(fmt::format(
        "radiosity: residual {:.3g} after {} iterations (wanted {}); emissivities below the error "
        "of the closure do not determine the radiosities",
        result.relative_residual, result.iterations, accepted_residual));
  return x;
}

/// Radiosities for emissive powers E, both above the same reference.
Vector radiosities(const ExchangeAreas& areas, const Vector& power, const Vector& emissivity,
                   RadiosityResult& result) {
  using namespace Eigen;
  const Vector emitted = emissivity.cwiseProduct(power),
               reflectivity = Vector::Ones(power.size()) - emissivity;
  if (reflectivity.isZero(0)) return emitted;
  const Vector area = multiply(areas, Vector::Ones(power.size()));
  const Vector inverse_area = (area.array() > 0).select(area.array().inverse(), 0.0);

  if (is_symmetric(areas)) {
    const Vector scale = reflectivity.cwiseProduct(inverse_area).cwiseSqrt();
    const Vector rhs = scale.cwiseProduct(multiply(areas, emitted));
    const ExchangeOperator op(areas, scale, scale);
    using Solver = ConjugateGradient<ExchangeOperator, Lower | Upper, IdentityPreconditioner>;
    return emitted + scale.cwiseProduct(solve<Solver>(op, rhs, result));
  }
  const ExchangeOperator op(areas, reflectivity.cwiseProduct(inverse_area), Vector::Ones(power.size()));
  return solve<BiCGSTAB<ExchangeOperator, IdentityPreconditioner>>(op, emitted, result);
}

void collect_heats(const ExchangeAreas& areas, const Vector& radiosity, RadiosityResult& result) {
  const std::vector<std::int64_t>& row = areas.pattern.row_begin;
  const std::vector<std::int32_t>& column = areas.pattern.column;
  const Eigen::Index count = radiosity.size();
  result.heat_W.assign(count, 0);
  if (!areas.variance.empty()) result.standard_error_W.assign(count, 0);
#pragma omp parallel for schedule(static) if (count >= many)
  for (Eigen::Index i = 0; i < count; ++i) {
    double heat = 0, variance = 0;
    for (auto k = row[i]; k < row[i + 1]; ++k) {
      const double difference = radiosity[column[k]] - radiosity[i];
      heat += areas.value[k] * difference;
      if (!areas.variance.empty()) variance += areas.variance[k] * difference * difference;
    }
    result.heat_W[i] = heat;
    if (!areas.variance.empty()) result.standard_error_W[i] = std::sqrt(variance);
  }
}

}  // namespace

RadiosityResult solve_radiosity(const ExchangeAreas& areas, const std::vector<double>& emissive_power_W_m2,
                                const std::vector<double>& emissivity) {
  const auto count = static_cast<Eigen::Index>(emissive_power_W_m2.size());
  const Eigen::Map<const Vector> power(emissive_power_W_m2.data(), count), eps(emissivity.data(), count);
  // Closed rows let any reference be taken off: an isothermal enclosure then gives exactly 0.
  double reference = infinity;
  for (Eigen::Index i = 0; i < count; ++i)
    if (eps[i] > 0 && areas.pattern.row_begin[i] < areas.pattern.row_begin[i + 1])
      reference = std::min(reference, power[i]);
  if (!std::isfinite(reference)) reference = 0;

  RadiosityResult result;
  const Vector above = (power.array() - reference).matrix();
  const Vector radiosity = radiosities(areas, above, eps, result);
  collect_heats(areas, radiosity, result);
  const Vector absolute = radiosity.array() + reference;
  result.radiosity_W_m2.assign(absolute.data(), absolute.data() + count);
  return result;
}

}  // namespace granrad
