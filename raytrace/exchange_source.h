#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// Radiative state of every surface of an enclosure, by surface number.
struct RadiativeState {
  std::vector<double> temperature_K;
  std::vector<double> emissivity;  ///< (0, 1]; surroundings 1
  std::vector<WallRole> role;      ///< particles are isothermal
};

/// Net radiative heat received by every surface.
struct RadiativeHeat {
  std::vector<double> heat_W;               ///< by surface number; sums to 0 within round-off
  std::vector<double> standard_error_W;     ///< same shape; empty when the source cannot estimate it
  double isothermal_wall_heat_W = 0;        ///< given by the isothermal and open walls to the particles
  double isothermal_wall_heat_error_W = 0;  ///< its standard error
  std::int64_t rays = 0;                    ///< traced for this update
  double closure_correction = 0;            ///< largest row correction, 0 when nothing was closed
};

/// Turns an enclosure into the radiative heat of each surface. One of the two virtual seams.
/// Same (enclosure, state, update) gives the same bits for any number of threads.
class ExchangeSource {
 public:
  virtual ~ExchangeSource() = default;
  /// `update` numbers the radiation updates of a run and selects the random numbers.
  virtual RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                 std::uint64_t update) = 0;
};

}  // namespace granrad
