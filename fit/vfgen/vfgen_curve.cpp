#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/files/text_file.h"
#include "dem/base/stated_number.h"
#include "fit/fitting/curve_fit.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

struct Columns {
  std::vector<double> x, y;
};

Columns read_columns(const CurveCommand& command) {
  const CsvTable table = read_csv(command.data);
  const std::size_t x = table.column(command.x), y = table.column(command.y);
  Columns columns;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const auto& cells = table.rows[k];
    if (cells[x].empty() || cells[y].empty()) continue;  // a missing value
    columns.x.push_back(cell_number(cells[x]));
    columns.y.push_back(cell_number(cells[y]));
    if (!std::isfinite(columns.x.back()) || !std::isfinite(columns.y.back()))
      throw InputError(
          fmt::format("{}:{}: {}, {} (must be numbers)", table.file, table.line[k], cells[x], cells[y]));
  }
  return columns;
}

}  // namespace

int run_curve(const CurveCommand& command, Verbosity verbosity) {
  const Columns columns = read_columns(command);
  const DataCurve fit = fit_curve(curve_form(command.form), columns.x, columns.y);
  nlohmann::ordered_json json;
  json["format"] = "granrad.curve";
  json["form"] = command.form;
  json["formula"] = curve_formula(fit);
  const std::string names = "abcd";
  for (std::size_t k = 0; k < fit.coefficient.size(); ++k)
    json["coefficients"][names.substr(k, 1)] = {{"value", fit.coefficient[k]},
                                                {"standard_error", fit.standard_error[k]}};
  json["points"] = fit.points;
  json["R2"] = fit.r_squared;
  json["rmse"] = fit.rmse;
  if (!command.output.empty()) write_text_file(command.output, json.dump(1) + "\n");
  if (verbosity != Verbosity::quiet) {
    fmt::print("{} = {}\n", command.y, curve_formula(fit));
    for (std::size_t k = 0; k < fit.coefficient.size(); ++k)
      fmt::print("  {} = {}\n", names[k], stated(fit.coefficient[k], fit.standard_error[k]).text(" +- "));
    fmt::print("  R2 {:.5f}, rms {:.3g}, {} points\n", fit.r_squared, fit.rmse, fit.points);
  }
  return exit_ok;
}

}  // namespace granrad
