#include "fit/correlation/correlation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "fit/correlation/unobstructed_pair.h"

namespace granrad {

const char* to_string(CorrelationForm form) {
  return form == CorrelationForm::cubic ? "cubic" : "transmittance";
}

const char* to_string(WallDistance convention) {
  return convention == WallDistance::centre_to_plane_over_d ? "centre_to_plane_over_d" : "h_plus_r_over_d";
}

std::size_t pp_coefficient_count(CorrelationForm form) {
  return form == CorrelationForm::cubic ? 4 : 2;
}
std::size_t pw_coefficient_count(CorrelationForm form) {
  return form == CorrelationForm::cubic ? 4 : 3;
}

namespace {

double cubic(const std::vector<double>& c, double d_star) {
  const double u = 1 / d_star;
  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

double pp_transmittance(const std::vector<double>& c, double d_star) {
  return std::exp(-c[0] * std::pow(d_star - 1, c[1]));
}

double pw_transmittance(const std::vector<double>& c, double h_over_d) {
  return c[0] * std::exp(-c[1] * std::pow(h_over_d - 0.5, c[2]));
}

/// The wall distance in the table's own convention.
double own_distance(WallDistance convention, double h_over_d) {
  return convention == WallDistance::h_plus_r_over_d ? h_over_d + 0.5 : h_over_d;
}

}  // namespace

double raw_pp(const CorrelationTable& table, const CorrelationRow& row, double d_star) {
  const double d = std::max(1.0, d_star);
  return table.form == CorrelationForm::cubic ? cubic(row.pp, d)
                                              : unobstructed_pair(d) * pp_transmittance(row.pp, d);
}

double raw_pw(const CorrelationTable& table, const CorrelationRow& row, double h_over_d,
              double unobstructed) {
  const double h = std::max(0.5, h_over_d);
  return table.form == CorrelationForm::cubic ? cubic(row.pw, own_distance(table.pw_distance, h))
                                              : unobstructed * pw_transmittance(row.pw, h);
}

Correlation::Correlation(const CorrelationTable& table, double solid_fraction)
    : table_(table), solid_fraction_(solid_fraction), pp_cutoff_(table.pp_cutoff) {
  const auto& rows = table.rows;
  const double low = rows.front().solid_fraction, high = rows.back().solid_fraction;
  if (!(solid_fraction >= low * (1 - solid_fraction_tolerance) &&
        solid_fraction <= high * (1 + solid_fraction_tolerance)))
    throw InputError(
        fmt::format("{}: solid fraction = {:.4g} (the table holds {:.4g} to {:.4g} and does not extrapolate) "
                    "use a table fitted at this solid fraction: vfgen generate, or vfgen trace and vfgen fit",
                    table.name, solid_fraction, low, high));
  auto upper = std::find_if(rows.begin(), rows.end(),
                            [&](const CorrelationRow& row) { return row.solid_fraction >= solid_fraction; });
  if (upper == rows.end()) upper = rows.end() - 1;
  const auto lower = upper == rows.begin() || upper->solid_fraction <= solid_fraction ? upper : upper - 1;
  if (lower != upper)
    upper_weight_ =
        (solid_fraction - lower->solid_fraction) / (upper->solid_fraction - lower->solid_fraction);
  table_.rows = {*lower, *upper};

  const auto count = static_cast<std::size_t>(std::ceil((pp_cutoff_ - 1) * steps_per_d)) + 2;
  pp_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double d_star = 1 + static_cast<double>(k) / steps_per_d;
    const double exact = unobstructed_pair(d_star);
    pp_[k] = row_pp(table_.rows[0], d_star, exact);
    if (upper_weight_ > 0) pp_[k] += upper_weight_ * (row_pp(table_.rows[1], d_star, exact) - pp_[k]);
  }
}

double Correlation::row_pp(const CorrelationRow& row, double d_star, double exact) const {
  const double raw = table_.form == CorrelationForm::cubic ? cubic(row.pp, d_star)
                                                           : exact * pp_transmittance(row.pp, d_star);
  return std::min(std::max(raw, table_.clip), exact);
}

double Correlation::row_pw(const CorrelationRow& row, double h_over_d, double unobstructed) const {
  return std::min(std::max(raw_pw(table_, row, h_over_d, unobstructed), table_.clip), 0.5);
}

double Correlation::pw(double h_over_d, double unobstructed) const {
  if (own_distance(table_.pw_distance, h_over_d) >= table_.pw_cutoff) return 0;
  const double lower = row_pw(table_.rows[0], h_over_d, unobstructed);
  if (upper_weight_ == 0) return lower;
  return lower + upper_weight_ * (row_pw(table_.rows[1], h_over_d, unobstructed) - lower);
}

}  // namespace granrad
