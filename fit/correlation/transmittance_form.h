#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "dem/base/error.h"
#include "fit/correlation/form.h"

namespace granrad {

/// The exact factor with nothing in between times what gets through the bed, always within [0, exact]; a form of this
/// project after Beer's law, in place of the paper's cubics (table of its Eqs. for F_pp and F_pw):
///   pairs  F = F_exact(d*) exp(-a (d* - 1)^b)
///   walls  F = F_exact(centre, wall) t0 exp(-c (h/d - 1/2)^e)
/// a and c are extinctions: they vanish with the solid fraction, about in proportion.
struct TransmittanceForm {
  static constexpr const char* name = "transmittance";
  static constexpr const char* formulas =
      "pairs: F = F_exact(d*) exp(−a (d* − 1)^b); walls: F = F_exact(centre, wall) t0 exp(−c (h/d − 1/2)^e)";
  static constexpr bool wall_distance_from_surface = false, wall_geometry = true, positive = true;

  static constexpr std::size_t count(Partner partner) { return partner == Partner::sphere ? 2 : 3; }
  static std::vector<std::string> names(Partner partner) {
    if (partner == Partner::sphere) return {"a", "b"};
    return {"t0", "c", "e"};
  }

  static std::string problem(Partner partner, const std::vector<double>& c) {
    if (partner == Partner::sphere && (c[0] < 0 || c[1] <= 0))
      return advised("a or b is negative (F would exceed the unobstructed value)", "both must be positive");
    if (partner == Partner::wall && (c[0] <= 0 || c[1] < 0 || c[2] <= 0))
      return advised("t0, c or e is negative (F would grow with distance)", "all must be positive");
    return "";
  }

  static std::vector<double> start(Partner partner) {
    if (partner == Partner::sphere) return {0.2, 1.5};
    return {1, 0.5, 1};
  }

  static double value(Partner partner, const double* c, double distance, double exact, double* derivative) {
    return partner == Partner::sphere ? attenuated(1, c[0], c[1], distance - 1, exact, nullptr, derivative)
                                      : attenuated(c[0], c[1], c[2], distance - 0.5, exact, derivative,
                                                   derivative ? derivative + 1 : nullptr);
  }

  /// Logarithms of the extinction and of t0, and the exponent, linear in logit(phi) = ln(phi / (1 - phi)).
  static CurveState between(Partner partner, const std::vector<double>& lower,
                            const std::vector<double>& upper, double lower_fraction, double upper_fraction,
                            double solid_fraction) {
    const auto logit = [](double phi) { return std::log(phi / (1 - phi)); };
    const double t =
        (logit(solid_fraction) - logit(lower_fraction)) / (logit(upper_fraction) - logit(lower_fraction));
    const auto linear = [&](std::size_t k) { return lower[k] + t * (upper[k] - lower[k]); };
    const auto logarithmic = [&](std::size_t k) {
      return lower[k] > 0 && upper[k] > 0 ? lower[k] * std::pow(upper[k] / lower[k], t) : linear(k);
    };
    if (partner == Partner::sphere) return {{logarithmic(0), linear(1)}, 0};
    return {{logarithmic(0), logarithmic(1), linear(2)}, 0};
  }

  /// Extinction in proportion to phi, as in a dilute bed.
  static CurveState below(Partner partner, const std::vector<double>& row, double row_fraction,
                          double solid_fraction) {
    const double t = solid_fraction / row_fraction;
    if (partner == Partner::sphere) return {{t * row[0], row[1]}, 0};
    return {{std::pow(row[0], t), t * row[1], row[2]}, 0};
  }

 private:
  /// f0 t0 exp(-c s^e), with the derivative by t0 and those by c and e.
  static double attenuated(double t0, double c, double e, double s, double f0, double* by_t0,
                           double* by_c_e) {
    const double power = s > 0 ? std::pow(s, e) : 0;
    const double per_t0 = f0 * std::exp(-c * power), value = t0 * per_t0;
    if (by_t0) *by_t0 = per_t0;
    if (by_c_e) {
      by_c_e[0] = -value * power;
      by_c_e[1] = s > 0 ? -value * c * power * std::log(s) : 0;
    }
    return value;
  }
};

}  // namespace granrad
