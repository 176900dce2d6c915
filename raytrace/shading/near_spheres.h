#pragma once
#include <cstdint>
#include <vector>

#include "dem/bed/cell_grid.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// Spheres near another, sorted by distance; in diameters of that sphere, from its centre.
struct Neighbours {
  std::vector<Vec3> place;
  std::vector<double> distance;
  std::vector<std::int32_t> number;
  std::vector<float> x, y, z, distance2, radius2;  ///< for the search along a pair

  std::size_t size() const { return number.size(); }
};

/// Those of neighbours [begin, begin + count) that may block lines along a unit axis, and where along it.
struct Stretch {
  static constexpr std::size_t longest = 64;
  float along[longest];
  std::int32_t near_axis[longest];  ///< 0 or 1

  /// Whether any may block lines of the given length.
  bool measure(const Neighbours& near, std::size_t begin, std::size_t count, float ax, float ay, float az,
               float length);
};

/// How far pairs are followed.
struct Reach {
  double diameters;
  double beyond;  ///< share that goes on from there
};

/// Finds the spheres within reach of each other: as far as more than 5e-4 of what a sphere sends gets by Beer's law at the
/// solid fraction of the spheres' bounding box, at least 6 diameters, not so far that more than 20 000 are met.
class NearSpheres {
 public:
  explicit NearSpheres(const Enclosure& enclosure);  ///< keeps a reference; precondition: there are spheres

  const Reach& reach() const { return reach_; }
  /// Those around sphere i, also just beyond the reach: they may block.
  Neighbours of(std::int32_t i) const;

 private:
  const Enclosure& enclosure_;
  Reach reach_;
  CellGrid grid_;
};

}  // namespace granrad
