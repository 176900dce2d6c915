#pragma once
#include <algorithm>
#include <vector>

#include "fit/correlation/correlation.h"

namespace granrad {

/// A curve to fit: F as a function of distance and of the unobstructed F, with its derivatives by the
/// coefficients.
struct Curve {
  CorrelationForm form = CorrelationForm::cubic;
  Partner partner = Partner::sphere;
  WallDistance pw_distance = WallDistance::centre_to_plane_over_d;  ///< of the coefficients; samples have h/d

  std::size_t size() const { return coefficient_count(form, partner); }
  /// Value; `derivative` [size()] may be null. `distance`: d* of a pair, h/d of a wall.
  double value(const double* coefficient, double distance, double unobstructed, double* derivative) const {
    const double at = partner == Partner::sphere ? std::max(distance, 1.0)
                                                 : wall_distance(pw_distance, std::max(distance, 0.5));
    return form_value(form, partner, coefficient, at, unobstructed, derivative);
  }
};

}  // namespace granrad
