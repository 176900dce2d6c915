#include "coupling/results/profiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/base/constants.h"

namespace granrad {

namespace {

/// Volume of a unit sphere below the plane at x in [-1, 1].
double cap(double x) {
  x = std::clamp(x, -1.0, 1.0);
  return pi * (2.0 / 3 + x - x * x * x / 3);
}

struct Sums {
  double volume = 0, count = 0, temperature = 0, velocity = 0, heat = 0;
};

bool inside_across(const Box& region, const Vec3& p, int axis) {
  for (int a = 0; a < 3; ++a)
    if (a != axis && (p[a] < region.min[a] || p[a] > region.max[a])) return false;
  return true;
}

/// `at`: the centre inside the box. Slices that fill a period take in the caps of its images.
void add_particle(std::vector<Sums>& sums, const Bed& bed, std::size_t i, const Vec3& at, const Box& region,
                  int axis) {
  const double thickness = region.size()[axis] / static_cast<double>(sums.size());
  const double x = at[axis] - region.min[axis], r = bed.radius_m[i];
  const auto count = static_cast<long>(sums.size()), last = count - 1;
  const bool wraps = bed.periodic[axis] && region.size()[axis] > (1 - 1e-9) * bed.box.size()[axis] &&
                     2 * r < thickness * count;
  const long low_slice = static_cast<long>(std::floor((x - r) / thickness)),
             high_slice = static_cast<long>(std::floor((x + r) / thickness));
  const long first = wraps ? low_slice : std::max(0L, low_slice),
             end = wraps ? high_slice : std::min(last, high_slice);
  for (long k = first; k <= end; ++k) {
    const double low = static_cast<double>(k) * thickness;
    sums[(k + count) % count].volume += r * r * r * (cap((low + thickness - x) / r) - cap((low - x) / r));
  }
  const long home = static_cast<long>(std::floor(x / thickness));
  if (home < 0 || home > last) return;
  sums[home].count += 1;
  sums[home].temperature += bed.temperature_K[i];
  sums[home].velocity -= bed.velocity_m_s[i].z;
  sums[home].heat += bed.radiative_heat_W[i];
}

}  // namespace

Profile profile(const std::vector<Bed>& beds, const Box& region, int axis, int slices) {
  std::vector<Sums> sums(slices);
  for (const Bed& bed : beds)
    for (std::size_t i = 0; i < bed.size(); ++i) {
      const Vec3 at = wrapped_into_box(bed, bed.position_m[i]);
      if (inside_across(region, at, axis)) add_particle(sums, bed, i, at, region, axis);
    }
  const double volume = region.volume() / slices * static_cast<double>(std::max<std::size_t>(beds.size(), 1));
  Profile result;
  for (int k = 0; k < slices; ++k) {
    const Sums& s = sums[k];
    const double n = s.count > 0 ? s.count : std::numeric_limits<double>::quiet_NaN();
    result.position_m.push_back(region.min[axis] + (k + 0.5) * region.size()[axis] / slices);
    result.solid_fraction.push_back(s.volume / volume);
    result.temperature_K.push_back(s.temperature / n);
    result.velocity_m_s.push_back(s.velocity / n);
    result.radiative_heat_W.push_back(s.heat / n);
  }
  return result;
}

}  // namespace granrad
