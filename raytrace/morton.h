#pragma once
#include <cstdint>

#include "dem/base/vec3.h"

namespace granrad {

/// Place of a cell along the Morton curve: 10 bits of each coordinate in turn, of x first. Precondition: each
/// in [0, 1024).
inline std::uint32_t morton_code(const Vec3& cell) {
  std::uint32_t code = 0;
  for (int bit = 9; bit >= 0; --bit)
    for (int axis = 0; axis < 3; ++axis)
      code = code << 1 | (static_cast<std::uint32_t>(cell[axis]) >> bit & 1);
  return code;
}

}  // namespace granrad
