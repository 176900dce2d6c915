#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "fit/correlation/correlation.h"
#include "fit/correlation/solid_fraction_field.h"
#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

/// Where what walls exchange comes from.
enum class WallRows {
  table,   ///< F_pw of the table; between walls geometry times Beer's law
  traced,  ///< rays from every wall, anew for each enclosure: only pairs of particles come from the table
};

class WallPatches;

struct CorrelationUse {
  double solid_fraction = 0;  ///< of the whole; 0: measured from each enclosure
  bool uniform = false;       ///< take the bed as uniform whatever its local solid fractions
  WallRows wall_rows = WallRows::table;
  double wall_rays = 300;  ///< traced: all walls together, per sphere of the enclosure
  const WallPatches* patches =
      nullptr;  ///< traced: of the walls; surfaces are then those of patches->applied_to(enclosure)
  std::uint64_t seed = 1;
  int threads = 0;
};

/// What reading a table for a bed came to.
struct CorrelationUsed {
  double solid_fraction = 0;  ///< of the whole
  double deviation = 0;       ///< rms of the local ones, relative (SolidFractionField)
  bool local = false;         ///< whether the local ones were used
  double farthest = 0;        ///< d* up to which pairs were kept
};

/// Exchange areas X_ij = A_i F_ij of an enclosure from a table, not yet closed; no variances. Symmetric.
///  - Sphere to sphere: A F_pp(d*), d* = centre distance / (r_i + r_j), at the solid fraction around the middle
///    of the pair. Zeros are not stored, nor distances beyond which all pairs together hold less than 2e-4 of a
///    row, in uniform beds; closure gives that back.
///  - Sphere to wall: A F_pw(h/d), at the mean solid fraction between them, and the same for the wall
///    (reciprocity); or traced.
///  - Wall to wall: geometry times Beer's law (fit/correlation/wall_exchange.h): a closure needs a real estimate,
///    and the table has none; or traced.
///  - Surroundings: what is missing to the surface's area, where it sees an opening between the walls.
/// Cost O(N * neighbours within the cutoff). Throws InputError for what a table cannot serve: radii that
/// differ by more than 1 %, walls that are meshes, periodic boxes, solid fractions above the last row.
ExchangeAreas correlation_exchange_areas(const CorrelationTable& table, const Enclosure& enclosure,
                                         const CorrelationUse& use, std::uint64_t update = 0,
                                         CorrelationUsed* used = nullptr);

/// The same as a function for a radiosity source of whole walls.
std::function<ExchangeAreas(const Enclosure&, std::uint64_t update)> correlation_exchange(
    CorrelationTable table, CorrelationUse use = {});

}  // namespace granrad
