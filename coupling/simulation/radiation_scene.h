#pragma once
#include "coupling/simulation/heat_scene.h"

namespace granrad {

/// A source of radiative exchange: [radiation], or one that is compared. Problems are recorded in the table.
RadiationSettings read_source(TomlTable table, const Scene& scene, RadiationKind otherwise);

/// [radiation]: a source, and how often it is asked.
RadiationSettings read_radiation(TomlTable table, const Scene& scene);

}  // namespace granrad
