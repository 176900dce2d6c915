#pragma once
#include <array>
#include <vector>

#include "fit/correlation/correlation.h"

namespace granrad {

/// A curve to fit: F as a function of distance and of the unobstructed F, with its derivatives by the fitted
/// parameters. Coefficients of the transmittance forms that must be positive are fitted as logarithms.
struct Curve {
  CorrelationForm form = CorrelationForm::cubic;
  bool wall = false;  ///< false: pair (contact at 1), true: wall (h/d, contact at 0.5)

  static constexpr int most_parameters = 4;
  int parameters() const {
    return static_cast<int>(wall ? pw_coefficient_count(form) : pp_coefficient_count(form));
  }
  /// Value; `derivative` [parameters()] may be null.
  double value(const double* parameter, double distance, double unobstructed, double* derivative) const;

  std::vector<double> start() const;                                             ///< parameters to start from
  std::vector<double> coefficients(const std::vector<double>& parameter) const;  ///< of the table
  /// Standard errors of the coefficients from those of the parameters.
  std::vector<double> coefficient_errors(const std::vector<double>& parameter,
                                         const std::vector<double>& parameter_error) const;
};

}  // namespace granrad
