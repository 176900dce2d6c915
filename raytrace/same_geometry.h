#pragma once
#include "raytrace/enclosure.h"

namespace granrad {

/// True when every sphere and wall stands exactly where it stood: what was built for one enclosure serves the
/// other. Roles, temperatures and emissivities of walls do not matter.
bool same_geometry(const Enclosure& a, const Enclosure& b);

/// A number drawn from the bits of all positions and radii: equal for the same geometry, unrelated for
/// another.
std::uint64_t geometry_key(const Enclosure& enclosure);

}  // namespace granrad
