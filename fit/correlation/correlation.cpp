#include "fit/correlation/correlation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "raytrace/unobstructed_pair.h"

namespace granrad {

namespace {

const std::vector<double>& coefficients(const CorrelationRow& row, Partner partner) {
  return partner == Partner::sphere ? row.pp : row.pw;
}

CurveState row_state(const std::vector<double>& coefficient) {
  CurveState state;
  std::copy(coefficient.begin(), coefficient.end(), state.coefficient.begin());
  return state;
}

/// The curve of a table at a solid fraction that it reaches.
CurveState curve_at(const CorrelationTable& table, Partner partner, double solid_fraction) {
  const auto& rows = table.rows;
  const auto upper = std::find_if(rows.begin(), rows.end(), [&](const CorrelationRow& row) {
    return row.solid_fraction >= solid_fraction;
  });
  if (upper == rows.end()) return row_state(coefficients(rows.back(), partner));
  if (upper->solid_fraction == solid_fraction) return row_state(coefficients(*upper, partner));
  if (upper == rows.begin())
    return below_row(table.form, partner, coefficients(*upper, partner), upper->solid_fraction,
                     solid_fraction);
  const auto lower = upper - 1;
  return between_rows(table.form, partner, coefficients(*lower, partner), coefficients(*upper, partner),
                      lower->solid_fraction, upper->solid_fraction, solid_fraction);
}

double held(CorrelationForm form, Partner partner, const CurveState& state, double distance, double exact,
            double clip) {
  const double f = form_value(form, partner, state.coefficient.data(), distance, exact);
  return std::min(std::max(f + state.exact_share * exact, clip), exact);
}

}  // namespace

const char* to_string(WallDistance convention) {
  switch (convention) {
    case WallDistance::centre_to_plane_over_d:
      return "centre_to_plane_over_d";
    case WallDistance::h_plus_r_over_d:
      return "h_plus_r_over_d";
  }
  return "";
}

double wall_distance(WallDistance convention, double h_over_d) {
  return convention == WallDistance::h_plus_r_over_d ? h_over_d + 0.5 : h_over_d;
}

void require_solid_fraction(const CorrelationTable& table, double solid_fraction, const std::string& where) {
  const double high = table.rows.back().solid_fraction;
  if (solid_fraction >= 0 && solid_fraction <= high * (1 + solid_fraction_tolerance)) return;
  throw InputError(advised(
      fmt::format("{}: solid fraction of {} = {:.4g} (the table holds {:.4g} to {:.4g}, serves less, down to "
                  "the empty box, and does not extrapolate beyond)",
                  table.name, where, solid_fraction, table.rows.front().solid_fraction, high),
      "use a table that reaches it (granrad_moving_bed.toml for settled beds), make one with vfgen generate, "
      "or choose source = \"paths\" or \"lines\""));
}

double raw_pp(const CorrelationTable& table, const CorrelationRow& row, double d_star) {
  const double d = std::max(1.0, d_star);
  return form_value(table.form, Partner::sphere, row.pp.data(), d, unobstructed_pair(d));
}

double raw_pw(const CorrelationTable& table, const CorrelationRow& row, double h_over_d,
              double unobstructed) {
  return form_value(table.form, Partner::wall, row.pw.data(),
                    wall_distance(table.pw_distance, std::max(0.5, h_over_d)), unobstructed);
}

Correlation::Correlation(const CorrelationTable& table, double solid_fraction, double farthest)
    : form_(table.form),
      pw_distance_(table.pw_distance),
      solid_fraction_(solid_fraction),
      clip_(table.clip),
      pp_cutoff_(std::min(table.pp_cutoff, farthest)),
      pw_cutoff_(table.pw_cutoff) {
  require_solid_fraction(table, solid_fraction, "the bed");
  pw_state_ = curve_at(table, Partner::wall, solid_fraction);
  const CurveState pairs = curve_at(table, Partner::sphere, solid_fraction);
  const auto count = static_cast<std::size_t>(std::ceil((pp_cutoff_ - 1) * steps_per_d)) + 2;
  pp_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double d_star = 1 + static_cast<double>(k) / steps_per_d;
    pp_[k] = held(form_, Partner::sphere, pairs, d_star, unobstructed_pair(d_star), clip_);
  }
}

double Correlation::pw(double h_over_d, double unobstructed) const {
  const double distance = wall_distance(pw_distance_, std::max(0.5, h_over_d));
  return distance < pw_cutoff_ ? held(form_, Partner::wall, pw_state_, distance, unobstructed, clip_) : 0;
}

}  // namespace granrad
