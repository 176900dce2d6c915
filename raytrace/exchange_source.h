#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/base/constants.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// Radiative state of every surface of an enclosure, by surface number: all a source knows of a surface. What a
/// wall's role means is worked out once, by `add`. Of a second spectral band the state holds that band's
/// emissive powers and emissivities; the heats of the bands add up.
struct RadiativeState {
  std::vector<double> emissive_power_W_m2;  ///< sigma T^4
  std::vector<double> emissivity;           ///< [0, 1]; 0: re-radiates what meets it, 1: black
  std::vector<char> excluded;               ///< walls that are dropped before closure
  /// What the temperature of each particle will make of its heat until the next update: k = eps A s dt / (m c), s the
  /// slope of sigma T^4; 0 for walls, empty when not known. Sources that sample give particles their due by it.
  std::vector<double> relaxation{};
  /// Whether the emission of the end of the interval is meant, sigma T^4 linearised: E' = E + k Q / (eps A). With
  /// f = 1 / (1 + k) the heats are then those of a surface that emits and keeps the part f of what a grey one would,
  /// and sends the rest of what it absorbs out again at once, from all its surface alike.
  bool implicit = false;
  /// Standard error of the wall heat that is wanted of a source which chooses its own effort, W; 0: a first look.
  double wanted_error_W = 0;

  double kept_share(std::size_t surface) const { return implicit ? 1 / (1 + relaxation[surface]) : 1; }

  /// The next surface. Adiabatic walls have emissivity 0, open walls and the surroundings 1.
  void add(double temperature_K, double surface_emissivity, WallRole role = WallRole::isothermal) {
    emissive_power_W_m2.push_back(emissive_power(temperature_K));
    emissivity.push_back(role == WallRole::adiabatic ? 0 : role == WallRole::open ? 1 : surface_emissivity);
    excluded.push_back(role == WallRole::excluded);
  }
  /// Whether the surface emits and absorbs.
  bool radiates(std::size_t surface) const { return emissivity[surface] > 0 && !excluded[surface]; }
};

/// Net radiative heat received by every surface.
struct RadiativeHeat {
  std::vector<double> heat_W;               ///< by surface number; sums to 0 within round-off
  std::vector<double> standard_error_W;     ///< same shape; empty when the source cannot estimate it
  double isothermal_wall_heat_W = 0;        ///< given by the walls that radiate to the particles
  double isothermal_wall_heat_error_W = 0;  ///< its standard error
  std::int64_t rays = 0;                    ///< traced for this update
  std::int64_t lost_rays = 0;               ///< of them that met the back of a wall or did not end
  double closure_correction = 0;            ///< largest row correction, 0 when nothing was closed
  double reciprocity_rms = 0;               ///< of the view factors between particles, once closed
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
