#pragma once
#include <string>

#include "dem/bed/bed.h"

namespace granrad {

/// The particles as text for other programs, read back by read_snapshot as they were: every column of the Bed
/// (columns.h), positions wrapped into the periods, box and periodic directions. Walls are not in it. SI;
/// numbers in their shortest exact form.

/// LAMMPS text dump: id type x y z radius ..., type = material + 1.
std::string dump_text(const Bed& bed);
/// VTK PolyData, XML in ASCII: point data under the viewers' names; field data TimeValue, Step, Box, Periodic.
std::string vtp_text(const Bed& bed);
/// Comma-separated, the names in the first line. No box.
std::string csv_text(const Bed& bed);

/// The walls as VTK PolyData (.vtp): one cell a polygon or triangle, with wall (its number), temperature (K), emissivity
/// and role (0 isothermal, 1 adiabatic, 2 open, 3 excluded).
std::string walls_vtp_text(const Bed& bed);

}  // namespace granrad
