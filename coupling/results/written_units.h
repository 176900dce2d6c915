#pragma once
#include <string>

#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// A unit to print a quantity in: value in it = (SI value - at_zero) / per_one.
struct PrintUnit {
  std::string name;
  double per_one = 1;  ///< one of it, in SI
  double at_zero = 0;  ///< its zero, in SI (degC: 273.15)

  double of(double si) const { return (si - at_zero) / per_one; }
  double difference(double si) const { return si / per_one; }
};

/// The unit in which results of the kind `si_unit` ("kg/s", "K", "m/s", "s") are printed: the one the scene writes its own
/// in ("1.59 g/s", "20 degC", "4 cm/s", "2 min"), else SI. Of the feed for flows and velocities, of the particles, else
/// the first wall, for temperatures, the end time for times.
PrintUnit written_unit(const Case& c, const std::string& si_unit);

}  // namespace granrad
