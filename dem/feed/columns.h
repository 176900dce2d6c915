#pragma once
#include <unordered_map>
#include <vector>

#include "dem/bed/bed.h"

namespace granrad {

/// The spheres in and above a region, by the vertical column they stand in, to find the lowest free height at a
/// place. Positions and distances are those of the nearest image in a periodic box.
class Columns {
 public:
  /// Spheres of `radius_m` are to be set down above the bottom of `region`.
  Columns(const Bed& bed, const Box& region, double radius_m);
  void add(const Bed& bed, std::size_t particle);
  /// Lowest height of a centre at (x, y) from which no other sphere is above or beside it.
  double floor_m(const Bed& bed, double x, double y) const;

 private:
  std::int64_t key(double x, double y) const;

  double bottom_m_, radius_m_, width_m_ = 0;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> columns_;
};

}  // namespace granrad
