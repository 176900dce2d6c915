#include "raytrace/same_geometry.h"

#include <algorithm>

namespace granrad {

bool same_geometry(const Enclosure& a, const Enclosure& b) {
  return a.centre_m == b.centre_m && a.radius_m == b.radius_m && a.particle == b.particle &&
         a.periodic == b.periodic && a.box.min == b.box.min && a.box.max == b.box.max &&
         std::equal(a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(),
                    [](const Wall& v, const Wall& w) {
                      return v.vertices == w.vertices && v.triangles == w.triangles;
                    });
}

}  // namespace granrad
