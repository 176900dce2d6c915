#pragma once
#include <cstdint>
#include <functional>

#include "fit/correlation/correlation.h"
#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

/// Solid volume of the spheres / volume enclosed by the walls. Throws InputError when the walls do not
/// enclose a volume. The fits use the same measure, so that a table is read as it was made.
double solid_fraction(const Enclosure& enclosure);

/// Exchange areas X_ij = A_i F_ij of an enclosure from a table, not yet closed; no variances. Symmetric.
///  - sphere-sphere: A F_pp(d*), d* = centre distance / (r_i + r_j), up to the table's cutoff; zeros are not
///  stored.
///  - sphere-wall: A F_pw(h/d), and the same for the wall (reciprocity).
///  - wall-wall: geometry times Beer's law (fit/correlation/wall_exchange.h): a closure needs a real estimate, and the
///    table has none.
///  - surroundings: what is missing to the surface's area, where it sees an opening between the walls.
/// Cost O(N * neighbours within the cutoff). Throws InputError for what a table cannot serve: radii that
/// differ by more than 1 %, walls that are meshes, periodic boxes, a solid fraction outside the table.
ExchangeAreas correlation_exchange_areas(const CorrelationTable& table, const Enclosure& enclosure,
                                         double solid_fraction);

/// The same as a function for a radiosity source. solid_fraction 0: measured from each enclosure.
std::function<ExchangeAreas(const Enclosure&, std::uint64_t update)> correlation_exchange(
    CorrelationTable table, double solid_fraction = 0);

}  // namespace granrad
