#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// The exchange source the settings ask for; null for none. A correlation table is used at the solid
/// fractions of each enclosure it meets. Throws InputError, IoError (table).
std::unique_ptr<ExchangeSource> make_radiation_source(const RadiationSettings& settings, const Scene& scene,
                                                      int threads);

/// Throws what the source would throw for this bed, at little cost: InputError (solid fraction outside the
/// table, walls that the source cannot serve, and all that enclosure_check.h finds, whatever the source; where
/// rays leave for surroundings of unknown temperature, that too). Returns notes on what is probably a mistake.
std::vector<std::string> check_radiation(const RadiationSettings& settings, const Scene& scene,
                                         const Bed& bed, std::optional<double> surroundings_K);

/// The temperature of what rays meet beyond all walls: [surroundings], else that of the open walls if they
/// have one; empty where nothing says it.
std::optional<double> known_surroundings_K(const Scene& scene, std::optional<double> stated_K);

/// State of every surface of an enclosure of `bed` whose particles have the temperatures given (by particle);
/// the surroundings are black.
RadiativeState radiative_state(const Bed& bed, const std::vector<double>& temperature_K,
                               const Enclosure& enclosure, double surroundings_K);

/// One line for people: "paths, 10000 walks per update".
std::string describe(const RadiationSettings& settings);

}  // namespace granrad
