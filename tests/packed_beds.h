#pragma once
#include "dem/packing/packing.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// Hard spheres packed into `filled`, a part of the box whose six walls enclose them.
inline Enclosure packed_bed(const Box& box, const Box& filled, double solid_fraction, double radius_m,
                            std::uint64_t seed = 1) {
  PackingRequest request;
  request.where.box = filled;
  request.radius_m = equal_radii(filled, solid_fraction, radius_m);
  request.seed = seed;
  Enclosure bed;
  bed.centre_m = pack_spheres(request);
  bed.radius_m = request.radius_m;
  bed.box = box;
  const auto walls = box_walls(box);
  bed.walls.assign(walls.begin(), walls.end());
  return bed;
}

}  // namespace granrad
