#pragma once
#include "dem/bed/bed.h"

namespace granrad {

/// No particle yet, in a cube of black walls at one temperature; alumina's heat capacity.
inline Bed hot_box(double size_m, double wall_K, double emissivity) {
  Bed bed;
  Material m;
  m.density_kg_m3 = 3984;
  m.specific_heat_J_kgK = 755;
  m.emissivity = emissivity;
  bed.materials = {m};
  bed.box = {{0, 0, 0}, {size_m, size_m, size_m}};
  for (auto wall : box_walls(bed.box)) {
    wall.role = WallRole::isothermal;
    wall.temperature_K = wall_K;
    wall.emissivity = 1;
    bed.walls.push_back(wall);
  }
  return bed;
}

}  // namespace granrad
