#include "fit/fitting/curve.h"

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {

double cubic(const double* c, double distance, double* derivative) {
  const double u = 1 / distance;
  if (derivative) {
    derivative[0] = 1;
    for (int k = 1; k < 4; ++k) derivative[k] = derivative[k - 1] * u;
  }
  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

/// f0 exp(p0 - exp(p1) s^exp(p2)), derivatives by p0, p1, p2.
double attenuated(double p0, double p1, double p2, double s, double f0, double* derivative) {
  const double exponent = std::exp(p2);
  const double depth = s > 0 ? std::exp(p1) * std::pow(s, exponent) : 0;
  const double value = f0 * std::exp(p0 - depth);
  if (derivative) {
    derivative[0] = value;
    derivative[1] = -value * depth;
    derivative[2] = s > 0 ? -value * depth * exponent * std::log(s) : 0;
  }
  return value;
}

}  // namespace

double Curve::value(const double* parameter, double distance, double unobstructed, double* derivative) const {
  if (form == CorrelationForm::cubic)
    return cubic(parameter, std::max(distance, wall ? 0.5 : 1.0), derivative);
  if (wall)
    return attenuated(parameter[0], parameter[1], parameter[2], distance - 0.5, unobstructed, derivative);
  double all[3];
  const double f =
      attenuated(0, parameter[0], parameter[1], distance - 1, unobstructed, derivative ? all : nullptr);
  if (derivative) std::copy(all + 1, all + 3, derivative);
  return f;
}

std::vector<double> Curve::start() const {
  if (form == CorrelationForm::cubic) return {0, 0, 0, 0};
  if (wall) return {0, std::log(0.5), 0};
  return {std::log(0.2), std::log(1.5)};
}

std::vector<double> Curve::coefficients(const std::vector<double>& parameter) const {
  std::vector<double> c = parameter;
  if (form == CorrelationForm::transmittance)
    for (double& v : c) v = std::exp(v);
  return c;
}

std::vector<double> Curve::coefficient_errors(const std::vector<double>& parameter,
                                              const std::vector<double>& parameter_error) const {
  std::vector<double> errors = parameter_error;
  if (form == CorrelationForm::transmittance)
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] *= std::exp(parameter[k]);
  return errors;
}

}  // namespace granrad
