#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

class TomlDocument;

/// How F depends on distance.
///  cubic          F = c0 + c1/d* + c2/d*^2 + c3/d*^3, for pairs (pp) and walls (pw): 4 + 4 coefficients (the
///  paper's form) transmittance  pp: F = F_exact(d*) exp(-a (d* - 1)^b), the unobstructed two-sphere factor
///  times what gets through;
///                 pw: F = F_exact(centre, wall) T, T = t0 exp(-c (h/d - 1/2)^e): 2 + 3 coefficients
enum class CorrelationForm { cubic, transmittance };

/// What d*_pw means. h: distance from the centre of the particle to the plane of the wall.
enum class WallDistance {
  centre_to_plane_over_d,  ///< h / d, contact at 0.5
  h_plus_r_over_d,  ///< (h + r) / d, contact at 1: the only reading in which the paper's F_pw make sense
};

/// How good a row is, as its fit measured it (0: not measured). RMSEs are of F, over all pairs within the
/// cutoff, invisible ones (F = 0) included; noise of the ray tracing is not subtracted.
struct RowStatistics {
  double pp_samples = 0, pw_samples = 0;
  double pp_rmse = 0, pw_rmse = 0;
  double pp_ray_noise = 0, pw_ray_noise = 0;  ///< RMSE that the finite number of rays alone gives
  double pp_scatter = 0,
         pw_scatter = 0;  ///< noise-free scatter about the mean at one d*: no curve can beat it
  double pp_held_out_rmse = 0, pw_held_out_rmse = 0;  ///< on snapshots the fit has not seen
  double closure_mean = 0, closure_rms = 0;  ///< of the row sums of the particles minus 1, before closing
  std::vector<double> pp_standard_error, pw_standard_error;  ///< of the coefficients
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
///   format = "granrad.correlation"   version = 1
///   title  = "..."
///   form   = "cubic" | "transmittance"
///   pp_distance = "centre_distance_over_d"
///   pw_distance = "centre_to_plane_over_d" | "h_plus_r_over_d"     # transmittance: the first
///   pp_cutoff = 10, pw_cutoff = 10   # in d*, as named above; F = 0 beyond
///   clip = 0                         # F is never below
///   [[row]] solid_fraction, pp = [...], pw = [...]   # ascending in solid_fraction
///   [row.statistics]                 # optional: the fields of RowStatistics by name
///   [provenance]                     # optional: source, method, inputs, created_by, note (strings)
///
/// In use: overlapping spheres (d* < 1) and walls cut by a sphere take the value at contact. Values are held
/// within clip <= F_pp <= F_exact and clip <= F_pw <= 1/2. Between two rows F is interpolated linearly in the
/// solid fraction (for cubics the same as interpolating coefficients, up to the clipping). A solid fraction
/// outside the rows is refused, except within 2 % of the first or last (a flow holds its own within 1 %),
/// where that row itself is used.
struct CorrelationTable {
  std::string title;
  CorrelationForm form = CorrelationForm::cubic;
  WallDistance pw_distance = WallDistance::centre_to_plane_over_d;
  double pp_cutoff = 10, pw_cutoff = 10, clip = 0;
  std::vector<CorrelationRow> rows;
  std::vector<std::pair<std::string, std::string>> provenance;  ///< key, text
  std::string name = "table";                                   ///< used in messages: the file it came from
};

const char* to_string(CorrelationForm form);
const char* to_string(WallDistance convention);
/// Number of coefficients of the pair and of the wall function.
std::size_t pp_coefficient_count(CorrelationForm form);
std::size_t pw_coefficient_count(CorrelationForm form);

/// Largest d*_pp a table may reach.
inline constexpr double largest_pp_cutoff = 32;

/// Solid fraction beyond the end rows that is still served by them, relative.
inline constexpr double solid_fraction_tolerance = 0.02;

/// One row as a function, before and after the bounds. h_over_d is always centre-to-plane distance / d,
/// whatever the table's convention; `unobstructed` is the exact factor to the whole wall (cubics ignore it).
double raw_pp(const CorrelationTable& table, const CorrelationRow& row, double d_star);
double raw_pw(const CorrelationTable& table, const CorrelationRow& row, double h_over_d, double unobstructed);

/// A table at one solid fraction, ready for many evaluations. The pair function is tabulated at 1/512 in d*
/// (linear in between: error below 3e-5 where a bound sets in, 1e-6 elsewhere).
class Correlation {
 public:
  /// Throws InputError (with the bounds) when the solid fraction is outside the table's range.
  Correlation(const CorrelationTable& table, double solid_fraction);

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
  double row_pp(const CorrelationRow& row, double d_star, double exact) const;
  double row_pw(const CorrelationRow& row, double h_over_d, double unobstructed) const;

  CorrelationTable table_;  ///< the one or two rows in use
  double solid_fraction_, upper_weight_ = 0, pp_cutoff_;
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
