#pragma once
#include <map>
#include <string>

namespace granrad {

/// A number with its standard error; nan: not known.
struct Measured {
  double value = 0, error = 0;
};
using Quantities = std::map<std::string, Measured>;

/// Value of a formula (muParser: + - * / ^, sqrt, exp, ln, erfc, log10, min, max, a < b ? c : d ...) of named
/// quantities, and its error: half the change of the value when a quantity moves by its error to both sides,
/// added in squares over the quantities, which are taken as independent. Names may hold dots. nan when a
/// quantity it uses has no value; an error nan when one has an unknown error. Throws InputError (syntax, unknown name).
Measured evaluate(const std::string& formula, const Quantities& quantities);

/// As above, of text with {NAME} for quantities whose names are no words; `find` gives them and throws
/// InputError for those it does not know.
template <class Find>
Measured evaluate_with_braces(std::string formula, Find&& find) {
  Quantities used;
  for (std::size_t open; (open = formula.find('{')) != std::string::npos;) {
    const auto close = formula.find('}', open);
    const std::string name = formula.substr(open + 1, close == std::string::npos ? close : close - open - 1);
    const std::string word = "quantity_" + std::to_string(used.size());
    used[word] = find(name);
    formula.replace(open, close == std::string::npos ? close : close - open + 1, " " + word + " ");
  }
  return evaluate(formula, used);
}

}  // namespace granrad
