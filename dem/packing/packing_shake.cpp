#include "dem/packing/packing_shake.h"

#include <algorithm>

#include "dem/base/program.h"
#include "dem/base/random.h"
#include "dem/packing/packing_cells.h"

namespace granrad {

namespace {

constexpr double wanted_acceptance = 0.4;

/// Uniform in [-1, 1) in three directions from one block of random bits.
Vec3 random_in_cube(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const auto bits = random_bits(seed, stream, counter);
  const auto signed_unit = [](std::uint32_t b) { return b * 0x1.0p-31 - 1.0; };
  return {signed_unit(bits[0]), signed_unit(bits[1]), signed_unit(bits[2])};
}

/// False when the sphere would cross a wall; wraps in periodic directions.
bool brought_inside(const PackingBox& where, double radius, Vec3& p) {
  for (int k = 0; k < 3; ++k) {
    const double min = where.box.min[k], max = where.box.max[k];
    if (!where.periodic[k]) {
      if (p[k] < min + radius || p[k] > max - radius) return false;
      continue;
    }
    if (p[k] < min) p[k] += max - min;
    if (p[k] >= max) p[k] -= max - min;
  }
  return true;
}

}  // namespace

void shake_spheres(const PackingBox& where, const std::vector<double>& radius_m, std::vector<Vec3>& position,
                   const MoveLength& length, int sweeps, std::uint64_t seed, std::uint64_t stream,
                   const std::function<bool(const Vec3&)>& may_be_at) {
  if (position.empty()) return;
  const int n = static_cast<int>(position.size());
  const double largest = *std::max_element(radius_m.begin(), radius_m.end());
  PackingCells cells(where, 2 * largest, position);
  Vec3 step = length.shortest;

  const auto free_at = [&](int i, const Vec3& p) {
    return cells.all_near(p, [&](int j) {
      const Vec3 d = where.separation(p, position[j]);
      const double touching = radius_m[i] + radius_m[j];
      return j == i || dot(d, d) >= touching * touching;
    });
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    stop_if_interrupted();
    int accepted = 0;
    for (int i = 0; i < n; ++i) {
      if (may_be_at && !may_be_at(position[i])) continue;
      const auto counter = static_cast<std::uint64_t>(sweep) * n + i;
      const Vec3 u = random_in_cube(seed, stream, counter);
      Vec3 to = position[i] + Vec3{u.x * step.x, u.y * step.y, u.z * step.z};
      if (!brought_inside(where, radius_m[i], to) || (may_be_at && !may_be_at(to)) || !free_at(i, to))
        continue;
      position[i] = to;
      cells.update(i, to);
      ++accepted;
    }
    if (sweep >= sweeps / 2) continue;
    const double change = std::clamp(accepted / (wanted_acceptance * n), 0.8, 1.25);
    for (int k = 0; k < 3; ++k) step[k] = std::clamp(step[k] * change, length.shortest[k], length.longest[k]);
  }
}

}  // namespace granrad
