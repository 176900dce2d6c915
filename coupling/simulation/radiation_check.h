#pragma once
#include <optional>
#include <string>
#include <vector>

#include "coupling/simulation/radiation_source.h"

namespace granrad {

/// Records in the table what a source cannot do with this scene, and keys that it does not use.
void check_source(TomlTable& table, const RadiationSettings& settings, const Scene& scene);

/// Throws what the source would throw for this bed, at little cost: InputError (solid fraction outside the
/// table, walls that the source cannot serve, and all that enclosure_check.h finds, whatever the source; where
/// rays leave for surroundings of unknown temperature, that too). Returns notes on what is probably a mistake.
std::vector<std::string> check_radiation(const RadiationSettings& settings, const Scene& scene,
                                         const Bed& bed, std::optional<double> surroundings_K);

/// The temperature of what rays meet beyond all walls: [surroundings], else that of the open walls if they
/// have one; empty where nothing says it.
std::optional<double> known_surroundings_K(const Scene& scene, std::optional<double> stated_K);

}  // namespace granrad
