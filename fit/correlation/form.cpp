#include "fit/correlation/form.h"

#include "dem/base/error.h"
#include "fit/correlation/cubic_form.h"
#include "fit/correlation/transmittance_form.h"

namespace granrad {

namespace {

/// The only switch over forms: the compiler says when a case is missing.
template <class Use>
auto with_form(CorrelationForm form, Use&& use) {
  switch (form) {
    case CorrelationForm::cubic:
      return use(CubicForm{});
    case CorrelationForm::transmittance:
      return use(TransmittanceForm{});
  }
  throw NumericalError("a correlation form that does not exist");
}

}  // namespace

const char* to_string(CorrelationForm form) {
  return with_form(form, [](auto f) { return decltype(f)::name; });
}

CorrelationForm correlation_form(const std::string& name) {
  for (const auto form : correlation_forms)
    if (name == to_string(form)) return form;
  throw InputError(advised("form \"" + name + "\" does not exist", "choose cubic or transmittance"));
}

std::vector<std::string> correlation_form_names() {
  std::vector<std::string> names;
  for (const auto form : correlation_forms) names.emplace_back(to_string(form));
  return names;
}

std::string describe(CorrelationForm form) {
  return with_form(form, [](auto f) { return std::string(decltype(f)::formulas); });
}

std::size_t coefficient_count(CorrelationForm form, Partner partner) {
  return with_form(form, [&](auto f) { return f.count(partner); });
}

std::vector<std::string> coefficient_names(CorrelationForm form, Partner partner) {
  return with_form(form, [&](auto f) { return f.names(partner); });
}

std::string coefficient_problem(CorrelationForm form, Partner partner,
                                const std::vector<double>& coefficient) {
  return with_form(form, [&](auto f) { return f.problem(partner, coefficient); });
}

bool takes_wall_distance_from_surface(CorrelationForm form) {
  return with_form(form, [](auto f) { return decltype(f)::wall_distance_from_surface; });
}

bool knows_wall_geometry(CorrelationForm form) {
  return with_form(form, [](auto f) { return decltype(f)::wall_geometry; });
}

double form_value(CorrelationForm form, Partner partner, const double* coefficient, double distance,
                  double exact, double* derivative) {
  return with_form(form, [&](auto f) { return f.value(partner, coefficient, distance, exact, derivative); });
}

std::vector<double> first_guess(CorrelationForm form, Partner partner) {
  return with_form(form, [&](auto f) { return f.start(partner); });
}

bool fitted_as_logarithms(CorrelationForm form) {
  return with_form(form, [](auto f) { return decltype(f)::positive; });
}

CurveState between_rows(CorrelationForm form, Partner partner, const std::vector<double>& lower,
                        const std::vector<double>& upper, double lower_fraction, double upper_fraction,
                        double solid_fraction) {
  return with_form(form, [&](auto f) {
    return f.between(partner, lower, upper, lower_fraction, upper_fraction, solid_fraction);
  });
}

CurveState below_row(CorrelationForm form, Partner partner, const std::vector<double>& row,
                     double row_fraction, double solid_fraction) {
  return with_form(form, [&](auto f) { return f.below(partner, row, row_fraction, solid_fraction); });
}

}  // namespace granrad
