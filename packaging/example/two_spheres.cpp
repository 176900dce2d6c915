// The view factor of two touching spheres in a box, traced, beside the exact one.
#include <cmath>
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
  for (const Wall& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.add({0.004, 0.005, 0.005}, {}, 0.001, 300);
  bed.add({0.006, 0.005, 0.005}, {}, 0.001, 300);

  TraceOptions options;
  options.rays_per_particle = 200000;
  const HitCounts counts = trace_view_factors(make_enclosure(bed, bed.box), options);
  double hits = 0;
  for (auto k = counts.pattern.row_begin[0]; k < counts.pattern.row_begin[1]; ++k)
    if (counts.pattern.column[k] == 1) hits = double(counts.hits[k]);
  const double traced = hits / double(counts.launched[0]), exact = exact_two_sphere(0.001, 0.001, 0.002);
  std::printf("traced %.5f, exact %.5f\n", traced, exact);
  return std::abs(traced - exact) < 0.005 ? 0 : 1;  // eight standard errors
}
