#include "raytrace/same_geometry.h"

#include <algorithm>
#include <bit>

namespace granrad {

bool same_geometry(const Enclosure& a, const Enclosure& b) {
  return a.centre_m == b.centre_m && a.radius_m == b.radius_m && a.particle == b.particle &&
         a.periodic == b.periodic && a.box.min == b.box.min && a.box.max == b.box.max &&
         std::equal(a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(),
                    [](const Wall& v, const Wall& w) {
                      return v.vertices == w.vertices && v.triangles == w.triangles;
                    });
}

std::uint64_t geometry_key(const Enclosure& enclosure) {
  std::uint64_t key = 0;
  const auto mix = [&key](double value) {  // the finaliser of SplitMix64
    key = (key ^ std::bit_cast<std::uint64_t>(value)) + 0x9e3779b97f4a7c15ull;
    key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9ull;
    key = (key ^ (key >> 27)) * 0x94d049bb133111ebull;
    key ^= key >> 31;
  };
  const auto mix_point = [&mix](const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) mix(p[axis]);
  };
  for (const auto& centre : enclosure.centre_m) mix_point(centre);
  for (double radius : enclosure.radius_m) mix(radius);
  for (const auto& wall : enclosure.walls)
    for (const auto& vertex : wall.vertices) mix_point(vertex);
  return key;
}

}  // namespace granrad
