#include "dem/native/rows.h"

#include <cmath>

namespace granrad::native {

void Rows::round_motion(std::int64_t begin, std::int64_t end) {
  if (motion.empty()) return;
  for (std::int64_t k = 8 * begin; k < 8 * end; ++k) motion[k] = static_cast<float>(velocity[k]);
}

Periods::Periods(const Bed& bed) : origin(bed.box.min) {
  for (int a = 0; a < 3; ++a) {
    if (!bed.periodic[a]) continue;
    length[a] = bed.box.size()[a];
    inverse[a] = 1 / length[a];
    any = true;
  }
}

Vec3 Periods::nearest(Vec3 d) const {
  for (int a = 0; a < 3; ++a) d[a] -= length[a] * ScalarPack::round(d[a] * inverse[a]);
  return d;
}

Vec3 Periods::wrapped(Vec3 p) const {
  for (int a = 0; a < 3; ++a) p[a] -= length[a] * std::floor((p[a] - origin[a]) * inverse[a]);
  return p;
}

}  // namespace granrad::native
