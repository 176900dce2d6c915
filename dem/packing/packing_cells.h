#pragma once
#include <vector>

#include "dem/packing/packing.h"

namespace granrad {

/// Spheres of a packing sorted into cells at least `reach_m` wide, so that all spheres whose centres are
/// closer than that stand in the 27 cells around. Cells are linked lists: a moved sphere is relinked in O(1).
class PackingCells {
 public:
  /// Precondition: the box is at least 2 reach_m wide in periodic directions (one image interacts).
  PackingCells(const PackingBox& where, double reach_m, const std::vector<Vec3>& position);

  /// Call after sphere i has moved.
  void update(int i, const Vec3& position);

  /// Calls visit(j) for every sphere in the cells around `position` until it returns false.
  /// Returns whether every call returned true.
  template <class Visit>
  bool all_near(const Vec3& position, Visit&& visit) const {
    int low[3], high[3];
    const auto at = cell_of(position);
    for (int k = 0; k < 3; ++k) range(k, at[k], low[k], high[k]);
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          for (int j = first_[index(wrapped(0, x), wrapped(1, y), wrapped(2, z))]; j >= 0; j = next_[j])
            if (!visit(j)) return false;
    return true;
  }

 private:
  std::array<int, 3> cell_of(const Vec3& p) const;
  void range(int axis, int at, int& low, int& high) const;
  int wrapped(int axis, int c) const {
    return c < 0 ? c + count_[axis] : c >= count_[axis] ? c - count_[axis] : c;
  }
  int index(int x, int y, int z) const { return (z * count_[1] + y) * count_[0] + x; }
  void link(int i, int cell);
  void unlink(int i);

  PackingBox where_;
  std::array<int, 3> count_{};
  Vec3 cells_per_m_;
  std::vector<int> first_, next_, previous_, cell_;
};

}  // namespace granrad
