#pragma once
#include "dem/bed/wall.h"

namespace granrad {

/// Area of a wall inside a box or on its boundary, m^2: its polygon or triangles clipped at the six planes
/// (Sutherland-Hodgman; places nearer than 1e-9 of the box are the same place).
double area_inside(const Wall& wall, const Box& box);

}  // namespace granrad
