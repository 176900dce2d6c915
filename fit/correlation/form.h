#pragma once
#include <array>
#include <string>
#include <vector>

namespace granrad {

/// How F depends on distance. A form is one header (cubic_form.h, transmittance_form.h) and one case of the
/// switch in form.cpp; nothing else asks which form a table has.
enum class CorrelationForm { cubic, transmittance };
inline constexpr std::array correlation_forms = {CorrelationForm::cubic, CorrelationForm::transmittance};

/// What a particle exchanges with: another particle (pp) or a planar wall (pw).
enum class Partner { sphere, wall };

inline constexpr std::size_t most_coefficients = 4;

/// A curve at one solid fraction: F = exact_share F_exact + f(coefficients; distance, F_exact). Only between
/// the empty box and the first row of a table is exact_share not 0.
struct CurveState {
  std::array<double, most_coefficients> coefficient{};
  double exact_share = 0;
};

const char* to_string(CorrelationForm form);
/// The form of this name; a table or an option has checked that it is one.
CorrelationForm correlation_form(const std::string& name);
/// Names, for options that choose one.
std::vector<std::string> correlation_form_names();
/// One sentence for people, with the formulas.
std::string describe(CorrelationForm form);

std::size_t coefficient_count(CorrelationForm form, Partner partner);
std::vector<std::string> coefficient_names(CorrelationForm form, Partner partner);
/// What is wrong with the coefficients, as "cause; advice"; empty when nothing is.
std::string coefficient_problem(CorrelationForm form, Partner partner,
                                const std::vector<double>& coefficient);
/// Whether a wall distance may be (h + r)/d; else it is h/d.
bool takes_wall_distance_from_surface(CorrelationForm form);
/// Whether the wall function carries the geometry of each wall, so that it holds for walls of any size and at
/// any distance; a function of distance alone holds for walls and distances like those it was fitted to.
bool knows_wall_geometry(CorrelationForm form);

/// f, and its derivatives by the coefficients unless `derivative` is null. `distance` in the convention of
/// the table, at least that of contact; `exact`: the factor with nothing in between.
double form_value(CorrelationForm form, Partner partner, const double* coefficient, double distance,
                  double exact, double* derivative = nullptr);

/// For fitting: where to start, and whether the coefficients are positive (then their logarithms are fitted)
/// or enter linearly.
std::vector<double> first_guess(CorrelationForm form, Partner partner);
bool fitted_as_logarithms(CorrelationForm form);

/// The curve at a solid fraction between those of two rows.
CurveState between_rows(CorrelationForm form, Partner partner, const std::vector<double>& lower,
                        const std::vector<double>& upper, double lower_fraction, double upper_fraction,
                        double solid_fraction);
/// The curve below the first row: exact at 0, the row at its own solid fraction.
CurveState below_row(CorrelationForm form, Partner partner, const std::vector<double>& row,
                     double row_fraction, double solid_fraction);

}  // namespace granrad
