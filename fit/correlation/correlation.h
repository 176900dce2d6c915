#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fit/correlation/form.h"

namespace granrad {

class TomlDocument;

/// What d*_pw means. h: distance from the centre of the particle to the plane of the wall.
enum class WallDistance {
  centre_to_plane_over_d,  ///< h / d, contact at 0.5
  h_plus_r_over_d,  ///< (h + r) / d, contact at 1: the only reading in which the paper's F_pw make sense
};

/// How good a row is, as its fit measured it (0: not measured). RMSEs are of F, over all pairs within the
/// cutoff, invisible ones (F = 0) included; noise of the ray tracing is not subtracted.
struct RowStatistics {
  double snapshots = 0;
  double pp_samples = 0, pw_samples = 0;
  double pp_rmse = 0, pw_rmse = 0;
  double pp_ray_noise = 0, pw_ray_noise = 0;  ///< RMSE that the finite number of rays alone gives
  double pp_scatter = 0,
         pw_scatter = 0;  ///< noise-free scatter about the mean at one d*: no curve can beat it
  double pp_held_out_rmse = 0, pw_held_out_rmse = 0;  ///< on snapshots the fit has not seen
  /// Of the samples about the table without this row, interpolated between its neighbours: what the table is
  /// worth at solid fractions it does not list.
  double pp_left_out_rmse = 0, pw_left_out_rmse = 0;
  double closure_mean = 0, closure_rms = 0;  ///< of the row sums of the particles minus 1, before closing
  /// Of the coefficients, so that +- 1.96 of them cover 95 % (fit/fitting/fit_correlation.h).
  std::vector<double> pp_standard_error, pw_standard_error;
};

/// The coefficients at one solid fraction.
struct CorrelationRow {
  double solid_fraction = 0;
  std::vector<double> pp, pw;
  RowStatistics statistics;
};

/// View factors as functions of distance, for equal spheres. d*_pp = centre distance / d, contact at 1.
///
/// File (TOML, version 1, unknown keys are errors):
///   format = "granrad.correlation"
///   version = 1
///   title = "..."
///   form = "cubic" | "transmittance"
///   pp_distance = "centre_distance_over_d"
///   pw_distance = "centre_to_plane_over_d" | "h_plus_r_over_d"   # transmittance: the first
///   pp_cutoff = 10, pw_cutoff = 10     # in d*, as named above; F = 0 beyond
///   clip = 0                           # F is never below
///   [[row]]                            # ascending in solid_fraction
///   solid_fraction, pp = [...], pw = [...]
///   [row.statistics]                   # optional: the fields of RowStatistics by name
///   [provenance]                       # optional: source, method, inputs, created_by, note (strings)
///
/// In use:
///  - Overlapping spheres (d* < 1) and walls cut by a sphere take the value at contact.
///  - Bounds: clip <= F_pp <= the exact two-sphere factor; clip <= F_pw <= the exact factor of that sphere to
///    that wall, so that the walls of a box never hold more than 1 of a lone sphere.
///  - Between two rows the curves are interpolated as their form says (between_rows), below the first towards
///    the exact factors of the empty box (below_row).
///  - Above the last row a table does not extrapolate: within 5 % the last row serves (a flow's own solid
///    fraction fluctuates by 1 to 3 %), beyond it is refused.
struct CorrelationTable {
  std::string title;
  CorrelationForm form = CorrelationForm::cubic;
  WallDistance pw_distance = WallDistance::centre_to_plane_over_d;
  double pp_cutoff = 10, pw_cutoff = 10, clip = 0;
  std::vector<CorrelationRow> rows;
  std::vector<std::pair<std::string, std::string>> provenance;  ///< key, text
  std::string name = "table";                                   ///< used in messages: the file it came from
};

const char* to_string(WallDistance convention);
/// d*_pw of a wall at h/d in the convention.
double wall_distance(WallDistance convention, double h_over_d);

/// Largest d* a table may reach.
inline constexpr double largest_pp_cutoff = 32, largest_pw_cutoff = 1000;

/// Solid fraction beyond the last row that is still served by it, relative.
inline constexpr double solid_fraction_tolerance = 0.05;

/// Throws InputError, with the range and advice, when the table does not reach the solid fraction. `where`
/// says what has it: "the bed".
void require_solid_fraction(const CorrelationTable& table, double solid_fraction, const std::string& where);

/// One row as a function, before the bounds. h_over_d is always centre-to-plane distance / d, whatever the
/// table's convention; `unobstructed` is the exact factor to the whole wall.
double raw_pp(const CorrelationTable& table, const CorrelationRow& row, double d_star);
double raw_pw(const CorrelationTable& table, const CorrelationRow& row, double h_over_d, double unobstructed);

/// A table at one solid fraction, ready for many evaluations. The pair function is tabulated at 1/512 in d*
/// (linear in between: error below 3e-5 where a bound sets in, 1e-6 elsewhere).
class Correlation {
 public:
  /// `farthest`: pairs beyond are not asked for. Throws InputError when the table does not reach the solid
  /// fraction.
  Correlation(const CorrelationTable& table, double solid_fraction, double farthest = largest_pp_cutoff);

  double pp(double d_star) const {
    if (d_star >= pp_cutoff_) return 0;
    const double at = (d_star > 1 ? d_star - 1 : 0) * steps_per_d;
    const auto k = static_cast<std::size_t>(at);
    return pp_[k] + (at - static_cast<double>(k)) * (pp_[k + 1] - pp_[k]);
  }
  double pw(double h_over_d, double unobstructed) const;
  double pp_cutoff() const { return pp_cutoff_; }
  double solid_fraction() const { return solid_fraction_; }

 private:
  static constexpr double steps_per_d = 512;

  CorrelationForm form_;
  WallDistance pw_distance_;
  double solid_fraction_, clip_, pp_cutoff_, pw_cutoff_;
  CurveState pw_state_;
  std::vector<double> pp_;
};

/// Reads and validates a table. Throws IoError (cannot read) or InputError with every problem located.
CorrelationTable read_correlation(const std::filesystem::path& file);
/// The same of a document; `name` in messages.
CorrelationTable read_correlation(TomlDocument& document, const std::string& name);
CorrelationTable parse_correlation(const std::string& text, const std::string& name);
/// Writes a table whole or not at all, so that reading it back gives the same numbers.
void write_correlation(const std::filesystem::path& file, const CorrelationTable& table);
std::string correlation_text(const CorrelationTable& table);

}  // namespace granrad
