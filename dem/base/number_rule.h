#pragma once
#include <string>

#include "dem/base/constants.h"

namespace granrad {

/// What a number must be. `unit` is the SI unit of plain numbers ("m", "kg/s", "1"); a string value such as
/// "0.8 mm" or "1.59 g/s" is converted to it with UDUNITS, and a value of another dimension is a problem.
struct NumberRule {
  const char* unit = "1";
  double min = -infinity;
  double max = infinity;
  bool min_exclusive = false, max_exclusive = false;
  const char* why = "";  ///< reason printed with a violated bound, e.g. "grey diffuse surface"
};

bool inside(const NumberRule& rule, double value);
/// "in (0, 1]", "> 0 m"; "" when nothing is asked.
std::string bounds_text(const NumberRule& rule);
/// "a number in (0, 1]", "a number in m".
std::string expected_number(const NumberRule& rule);
/// Any value the rule allows, for a reader to go on with after a problem.
double placeholder(const NumberRule& rule);

}  // namespace granrad
