#pragma once
#include <fstream>
#include <string>

#include "dem/bed/bed.h"
#include "tests/source_dir.h"

namespace granrad {

/// The settled bed of data/reference/liggghts_bench: 12 500 alumina spheres of 0.8 mm at rest, periodic in x
/// and y, on a floor; repeated nx x ny times.
inline Bed settled_bed(int nx = 1, int ny = 1) {
  std::ifstream in(granrad::source_dir() + "/data/reference/liggghts_bench/bed12k.data");
  std::string line;
  while (std::getline(in, line) && line.rfind("Atoms", 0) != 0) {
  }
  std::vector<Vec3> points;
  double id, type, diameter, density;
  for (Vec3 p; in >> id >> type >> diameter >> density >> p.x >> p.y >> p.z;) points.push_back(p);
  Bed bed;
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23;
  m.restitution = 0.45, m.friction = 0.4;
  m.conductivity_W_mK = 33, m.specific_heat_J_kgK = 755, m.real_youngs_modulus_Pa = 3.7e11;
  bed.materials = {m};
  for (int a = 0; a < nx; ++a)
    for (int b = 0; b < ny; ++b)
      for (const auto& p : points) bed.add(p + Vec3{0.018 * a, 0.018 * b, 0}, {}, 4e-4, 300);
  bed.periodic = {true, true, false};
  bed.box = {{0, 0, -2e-4}, {0.018 * nx, 0.018 * ny, 0.045}};
  Wall floor;
  floor.name = "floor";
  floor.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  bed.walls = {floor};
  return bed;
}

}  // namespace granrad
