#pragma once
#include "raytrace/enclosure.h"

namespace granrad {

/// True when every sphere and wall stands exactly where it stood: what was built for one enclosure serves the
/// other. Roles, temperatures and emissivities of walls do not matter.
bool same_geometry(const Enclosure& a, const Enclosure& b);

}  // namespace granrad
