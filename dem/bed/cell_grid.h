#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Points sorted into cubic cells of at least `cell_m`, for "who is near". Memory is O(points) whatever the
/// extent: cells beyond some per point share a bucket, told apart by their coordinates. Along periodic
/// directions of `box` the cells wrap and tile the period; points must lie inside it there.
class CellGrid {
 public:
  /// Keeps a copy of the points listed by `members` (indices into `points`).
  CellGrid(const std::vector<Vec3>& points, std::vector<std::int32_t> members, double cell_m, const Box& box,
           const std::array<bool, 3>& periodic);
  /// Of all points, in a box without periods.
  CellGrid(const std::vector<Vec3>& points, double cell_m, const Box& box);

  /// The members in the order of their cells.
  const std::vector<std::int32_t>& members() const { return member_; }

  /// Calls visit(member, point) for every point in the cell of `p` and the 26 around it, each once: all
  /// points within cell_m of p (in the nearest periodic image) are among them.
  template <class Visit>
  void visit_around(const Vec3& p, Visit&& visit) const;
  /// The members that visit_around visits, ascending.
  std::vector<std::int32_t> around(const Vec3& p) const;
  /// Calls visit(member, point) for every point that may lie in the box; no wrapping.
  template <class Visit>
  void visit_box(const Box& range, Visit&& visit) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const;
  std::size_t bucket_of(const Cell& c) const {
    const std::uint64_t cell = (c[2] * count_[1] + c[1]) * count_[0] + c[0];
    return own_buckets_ ? cell : cell % (bucket_begin_.size() - 1);
  }
  /// Visits the cells x_first .. x_last of a row; neighbours in x are neighbours in memory.
  template <class Visit>
  void visit_row(std::int64_t x_first, std::int64_t x_last, std::int64_t y, std::int64_t z,
                 Visit&& visit) const;

  Vec3 origin_, inverse_size_;
  Cell count_;
  std::array<bool, 3> periodic_;
  bool own_buckets_;                        ///< every cell has a bucket of its own
  std::vector<std::int32_t> member_;        ///< by bucket
  std::vector<Vec3> point_;                 ///< by bucket
  std::vector<Cell> cell_;                  ///< by bucket
  std::vector<std::int32_t> bucket_begin_;  ///< [buckets + 1]
};

template <class Visit>
void CellGrid::visit_row(std::int64_t x_first, std::int64_t x_last, std::int64_t y, std::int64_t z,
                         Visit&& visit) const {
  if (own_buckets_) {
    const std::int32_t end = bucket_begin_[bucket_of({x_last, y, z}) + 1];
    for (std::int32_t k = bucket_begin_[bucket_of({x_first, y, z})]; k < end; ++k)
      visit(member_[k], point_[k]);
    return;
  }
  for (Cell cell{x_first, y, z}; cell[0] <= x_last; ++cell[0]) {
    const std::size_t bucket = bucket_of(cell);
    for (std::int32_t k = bucket_begin_[bucket]; k < bucket_begin_[bucket + 1]; ++k)
      if (cell_[k] == cell) visit(member_[k], point_[k]);
  }
}

template <class Visit>
void CellGrid::visit_around(const Vec3& p, Visit&& visit) const {
  const Cell centre = cell_of(p);
  std::array<std::array<std::int64_t, 3>, 3> along;  // cell coordinates to visit, by axis
  std::array<int, 3> n{};
  for (int axis = 0; axis < 3; ++axis)
    for (std::int64_t step = -1; step <= 1; ++step) {
      std::int64_t c = centre[axis] + step;
      if (periodic_[axis]) {
        if (step + 1 >= count_[axis]) break;  // one or two cells per period: each once
        c = (c + count_[axis]) % count_[axis];
      } else if (c < 0 || c >= count_[axis]) {
        continue;
      }
      along[axis][n[axis]++] = c;
    }
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const int first = i;
        while (i + 1 < n[0] && along[0][i + 1] == along[0][i] + 1) ++i;
        visit_row(along[0][first], along[0][i], along[1][j], along[2][k], visit);
      }
}

template <class Visit>
void CellGrid::visit_box(const Box& range, Visit&& visit) const {
  const Cell low = cell_of(range.min), high = cell_of(range.max);
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (high[axis] < 0 || low[axis] >= count_[axis]) return;
    cells *= static_cast<double>(high[axis] - low[axis] + 1);
  }
  if (cells > static_cast<double>(point_.size())) {
    for (std::size_t k = 0; k < point_.size(); ++k)
      if (range.contains(point_[k])) visit(member_[k], point_[k]);
    return;
  }
  for (auto z = std::max<std::int64_t>(low[2], 0); z <= std::min(high[2], count_[2] - 1); ++z)
    for (auto y = std::max<std::int64_t>(low[1], 0); y <= std::min(high[1], count_[1] - 1); ++y)
      visit_row(std::max<std::int64_t>(low[0], 0), std::min(high[0], count_[0] - 1), y, z, visit);
}

}  // namespace granrad
