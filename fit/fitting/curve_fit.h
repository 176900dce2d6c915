#pragma once
#include <string>
#include <vector>

namespace granrad {

/// The curves y(x) that results of a study are described by.
enum class CurveForm {
  power,                  ///< a x^b
  line,                   ///< a + b x
  logarithm,              ///< a ln(b x)
  exponential_logarithm,  ///< a e^(b x) + c ln(d x), fitted as a e^(b x) + c ln x + d'
};

/// Throws InputError for a name that is none of power, line, logarithm, exponential_logarithm.
CurveForm curve_form(const std::string& name);

struct DataCurve {
  CurveForm form = CurveForm::power;
  std::vector<double> coefficient, standard_error;  ///< a, b, c, d
  double r_squared = 0, rmse = 0;
  std::size_t points = 0;
};

/// Unweighted least squares by Ceres; standard errors by Ceres' covariance of the parameters times the residual
/// variance SSR / (n - p), carried to d = exp(d' / c) and b = exp(b' / a) to first order. Throws InputError with
/// fewer than p + 1 points, or points outside the domain (x > 0 where a logarithm or a power is taken),
/// NumericalError when the points do not determine the coefficients.
DataCurve fit_curve(CurveForm form, const std::vector<double>& x, const std::vector<double>& y);

/// "0.39 * ln(227.8 * x)", as a formula of x.
std::string curve_formula(const DataCurve& fit);

}  // namespace granrad
