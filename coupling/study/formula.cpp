#include "coupling/study/formula.h"

#include <fmt/core.h>
#include <muParser.h>

#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr const char* name_characters = "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.";

}  // namespace

Measured evaluate(const std::string& formula, const Quantities& quantities) {
  try {
    mu::Parser parser;
    parser.DefineNameChars(name_characters);
    parser.DefineFun("erfc", static_cast<double (*)(double)>(std::erfc));
    std::map<std::string, double> storage;
    for (const auto& [name, measured] : quantities) {
      if (name.empty() || name.find_first_not_of(name_characters) != std::string::npos ||
          std::isdigit(static_cast<unsigned char>(name.front())))
        continue;
      parser.DefineVar(name, &(storage[name] = measured.value));
    }
    parser.SetExpr(formula);
    Measured result{parser.Eval(), 0};
    const auto used = parser.GetUsedVar();  // a copy: evaluating changes the parser's own
    for (const auto& [name, variable] : used) {
      const double error = quantities.at(name).error;
      if (std::isnan(error)) result.error = error;  // not known: nor is that of the result
      if (!std::isfinite(error) || error <= 0) continue;
      const double value = *variable;
      *variable = value + error;
      const double above = parser.Eval();
      *variable = value - error;
      const double below = parser.Eval();
      *variable = value;
      result.error =
          std::isnan(result.error) ? result.error : std::hypot(result.error, 0.5 * (above - below));
    }
    return result;
  } catch (const mu::ParserError& error) {
    throw InputError(fmt::format("formula \"{}\": {}", formula, error.GetMsg()));
  }
}

}  // namespace granrad
