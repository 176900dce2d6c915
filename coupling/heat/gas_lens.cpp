#include "coupling/heat/gas_lens.h"

#include <algorithm>
#include <cmath>

#include "coupling/heat/contact_conductance.h"
#include "dem/base/constants.h"

namespace granrad {

namespace {

/// Both closed forms in one: the conductance is prefactor * f. `height` is the distance of the particle's
/// centre from the plane of symmetry (or the wall) over R, rim = sqrt(1 - r_out^2), rim_gap = 1 - overlap -
/// rim the (half) gap at the rim of the lens, computed without cancellation.
double lens_integral(double overlap, double minimum_gap, double rim, double rim_gap) {
  const double height = 1 - overlap;
  if (rim_gap <= minimum_gap)  // the gap is at its minimum all over the lens
    return ((1 - rim * rim) - std::max(0.0, 1 - height * height)) / (2 * minimum_gap);
  if (overlap >= 0) return rim + minimum_gap / 2 + height * std::log(rim_gap / minimum_gap);
  if (overlap > -minimum_gap) {
    const double depth = overlap + minimum_gap;  // of the cap in which the gap is at its minimum
    return depth * (2 - depth) / (2 * minimum_gap) + rim - (1 - depth) +
           height * std::log(rim_gap / minimum_gap);
  }
  const double cap = 1 - rim;
  return -cap + height * std::log1p(cap / -overlap);
}

/// Squared radius of the circle in which the lens of `owner` meets the sphere `other`: 0 when it does not
/// reach it, that sphere's own disc when it covers half of it.
double lens_disc_squared(double owner_m, double other_m, double distance_m, double lens_ratio) {
  const double lens = lens_ratio * owner_m;
  if (distance_m >= other_m + lens) return 0;
  const double depth = ((distance_m - lens) * (distance_m + lens) + other_m * other_m) / (2 * distance_m);
  return depth <= 0 ? other_m * other_m : std::max(0.0, (other_m - depth) * (other_m + depth));
}

/// Squared radius of the circle in which two spheres meet; 0 apart.
double common_circle_squared(double a_m, double b_m, double distance_m) {
  return contact_area_m2(a_m, b_m, distance_m) / pi;
}

}  // namespace

double pair_lens(double half_overlap, double half_minimum_gap, double lens_ratio) {
  const double height = 1 - half_overlap, distance = 2 * height, excess = lens_ratio * lens_ratio - 1;
  if (distance >= 1 + lens_ratio) return 0;
  const double rim = (distance * distance - excess) / (2 * distance);
  return rim > 0 ? pi * lens_integral(half_overlap, half_minimum_gap, rim, excess / (2 * distance))
                 : pi * lens_integral(half_overlap, half_minimum_gap, 0, height);
}

double wall_lens(double overlap, double minimum_gap, double lens_ratio) {
  const double height = 1 - overlap, excess = lens_ratio * lens_ratio - 1;
  if (height >= lens_ratio) return 0;
  const double rim_squared = height * height - excess;
  if (rim_squared <= 0) return 2 * pi * lens_integral(overlap, minimum_gap, 0, height);
  const double rim = std::sqrt(rim_squared);
  return 2 * pi * lens_integral(overlap, minimum_gap, rim, excess / (height + rim));
}

double lens_m(double radius_i_m, double radius_j_m, double distance_m, double minimum_gap_m,
              double lens_ratio) {
  const double difference = (radius_i_m - radius_j_m) * (radius_i_m + radius_j_m);
  const double outer2 = std::min(lens_disc_squared(radius_i_m, radius_j_m, distance_m, lens_ratio),
                                 lens_disc_squared(radius_j_m, radius_i_m, distance_m, lens_ratio));
  if (outer2 <= 0) return 0;
  const double inner2 = common_circle_squared(radius_i_m, radius_j_m, distance_m);
  const double flat2 =
      std::min(outer2, common_circle_squared(radius_i_m, radius_j_m, distance_m - minimum_gap_m));
  double sum = flat2 > inner2 ? pi * (flat2 - inner2) / minimum_gap_m : 0;
  if (flat2 >= outer2 || inner2 >= outer2) return sum;

  const auto sagitta = [](double radius, double disc2) {
    return disc2 / (radius + std::sqrt(std::max(0.0, radius * radius - disc2)));
  };
  const double axial_gap = distance_m - radius_i_m - radius_j_m;
  const double from = std::max(minimum_gap_m, axial_gap);
  const double to = axial_gap + sagitta(radius_i_m, outer2) + sagitta(radius_j_m, outer2);
  if (to <= from) return sum;
  const double growth = std::log(to / from), y_from = distance_m - from, y_to = distance_m - to;
  sum += pi / 2 * (distance_m * growth - (to - from));
  if (difference != 0) {
    const double cubic = (growth + std::log(y_from / y_to)) / (distance_m * distance_m * distance_m) +
                         (1 / y_to - 1 / y_from) / (distance_m * distance_m) +
                         (1 / (y_to * y_to) - 1 / (y_from * y_from)) / (2 * distance_m);
    sum -= pi / 2 * difference * difference * cubic;
  }
  return sum;
}

}  // namespace granrad
