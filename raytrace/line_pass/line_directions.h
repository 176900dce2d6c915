#pragma once
#include <cstdint>

#include "dem/base/vec3.h"

namespace granrad {

/// A set of parallel lines: direction w, lattice axes u and v (right-handed, unit), and where the lattice
/// stands, in [0, 1) of its spacing.
struct LineFrame {
  Vec3 u, v, w;
  double shift_u, shift_v;
};

/// Direction `index` of `count` spread evenly over the hemisphere (spherical Fibonacci lattice), turned by
/// one random rotation per replicate; roll about w and lattice shift are random for each direction. Every
/// direction alone is uniform on the sphere.
LineFrame line_frame(std::uint64_t seed, int replicate, int index, int count);

}  // namespace granrad
