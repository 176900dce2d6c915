#include "dem/native/rows.h"

#include <cmath>

namespace granrad::native {

void Rows::fill_mixed(std::int64_t begin, std::int64_t end) {
  if (mixed.empty()) return;
  for (std::int64_t i = begin; i < end; ++i) {
    for (int k = 0; k < 4; ++k) mixed[i].position[k] = position[4 * i + k];
    for (int k = 0; k < 8; ++k) mixed[i].velocity[k] = static_cast<float>(velocity[8 * i + k]);
  }
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
