#include <fmt/core.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "fit/fitting/curve_fit.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

struct Columns {
  std::vector<double> x, y;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

std::size_t column(const std::vector<std::string>& names, const std::string& name, const std::string& file) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return k;
  throw InputError(fmt::format("{}: has no column {}", file, name));
}

Columns read_columns(const CurveCommand& command) {
  std::ifstream in(command.data);
  std::string line;
  if (!std::getline(in, line)) throw IoError(fmt::format("{}: cannot be read", command.data.string()));
  const auto names = cells_of(line);
  const auto x = column(names, command.x, command.data.string()),
             y = column(names, command.y, command.data.string());
  Columns columns;
  for (int row = 2; std::getline(in, line); ++row) {
    const auto cells = cells_of(line);
    if (cells.size() <= std::max(x, y) || cells[x].empty() || cells[y].empty()) continue;  // a missing value
    char *x_end = nullptr, *y_end = nullptr;
    columns.x.push_back(std::strtod(cells[x].c_str(), &x_end));
    columns.y.push_back(std::strtod(cells[y].c_str(), &y_end));
    if (*x_end != '\0' || *y_end != '\0')
      throw InputError(
          fmt::format("{}:{}: {}, {} (must be numbers)", command.data.string(), row, cells[x], cells[y]));
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
      fmt::print("  {} = {:.6g} +- {:.2g}\n", names[k], fit.coefficient[k], fit.standard_error[k]);
    fmt::print("  R2 {:.5f}, rms {:.3g}, {} points\n", fit.r_squared, fit.rmse, fit.points);
  }
  return exit_ok;
}

}  // namespace granrad
