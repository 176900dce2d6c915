// Heat that two walls at 1000 K give to a sphere, by traced view factors, beside the exact factor of two spheres.
#include <cstdio>

#include "dem/bed/bed.h"
#include "raytrace/enclosure.h"
#include "raytrace/exact.h"
#include "raytrace/rays/view_factors.h"

int main() {
  using namespace granrad;
  Bed bed;
  bed.materials.emplace_back();
  bed.box = {{0, 0, 0}, {0.01, 0.01, 0.01}};
  for (auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.add({0.004, 0.005, 0.005}, {}, 0.001, 300);
  bed.add({0.006, 0.005, 0.005}, {}, 0.001, 300);

  ViewFactorSettings settings;
  settings.rays = 200000;
  const auto traced = trace_view_factors(make_enclosure(bed, bed.box), settings);
  const double exact = exact_two_sphere(0.001, 0.001, 0.002);
  std::printf("F of two touching spheres: traced %.5f, exact %.5f\n", traced.factor(0, 1), exact);
  return 0;
}
