#pragma once
#include <string>
#include <vector>

#include "fit/correlation/form.h"

namespace granrad {

/// F = c0 + c1/d* + c2/d*^2 + c3/d*^3 for pairs and walls: the form of the paper. A polynomial knows no
/// bounds; the table holds it within them.
struct CubicForm {
  static constexpr const char* name = "cubic";
  static constexpr const char* formulas = "F = c0 + c1/d* + c2/d*² + c3/d*³, for pairs and for walls";
  static constexpr bool wall_distance_from_surface = true, wall_geometry = false, positive = false;

  static constexpr std::size_t count(Partner) { return 4; }
  static std::vector<std::string> names(Partner) { return {"c0", "c1", "c2", "c3"}; }
  static std::string problem(Partner, const std::vector<double>&) { return ""; }
  static std::vector<double> start(Partner) { return {0, 0, 0, 0}; }

  static double value(Partner, const double* c, double distance, double /*exact*/, double* derivative) {
    const double u = 1 / distance;
    if (derivative) {
      derivative[0] = 1;
      for (int k = 1; k < 4; ++k) derivative[k] = derivative[k - 1] * u;
    }
    return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
  }

  /// Linear in the solid fraction, coefficients and F alike.
  static CurveState between(Partner, const std::vector<double>& lower, const std::vector<double>& upper,
                            double lower_fraction, double upper_fraction, double solid_fraction) {
    const double t = (solid_fraction - lower_fraction) / (upper_fraction - lower_fraction);
    CurveState state;
    for (int k = 0; k < 4; ++k) state.coefficient[k] = lower[k] + t * (upper[k] - lower[k]);
    return state;
  }

  static CurveState below(Partner, const std::vector<double>& row, double row_fraction,
                          double solid_fraction) {
    const double t = solid_fraction / row_fraction;
    CurveState state;
    for (int k = 0; k < 4; ++k) state.coefficient[k] = t * row[k];
    state.exact_share = 1 - t;
    return state;
  }
};

}  // namespace granrad
