#include "dem/bed/cell_grid.h"

#include <cmath>
#include <numeric>

namespace granrad {

namespace {

constexpr double most_cells = 1 << 20;  ///< along one direction
constexpr std::uint64_t buckets_per_point = 16;
/// Cells are larger than asked by this part, so that round-off of cell coordinates (most_cells * 2^-52) never
/// puts two points within `cell_m` two cells apart.
constexpr double cell_margin = 1 + 1e-9;

std::vector<std::int32_t> all_of(const std::vector<Vec3>& points) {
  std::vector<std::int32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

CellGrid::CellGrid(const std::vector<Vec3>& points, double cell_m, const Box& box)
    : CellGrid(points, all_of(points), cell_m, box, {}) {}

std::vector<std::int32_t> CellGrid::around(const Vec3& p) const {
  std::vector<std::int32_t> found;
  visit_around(p, [&](std::int32_t member, const Vec3&) { found.push_back(member); });
  std::sort(found.begin(), found.end());
  return found;
}

CellGrid::CellGrid(const std::vector<Vec3>& points, std::vector<std::int32_t> members, double cell_m,
                   const Box& box, const std::array<bool, 3>& periodic)
    : periodic_(periodic) {
  Box extent = members.empty() ? Box{} : Box::empty();
  for (const auto m : members) extent.include(points[m]);
  std::uint64_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = periodic[axis] ? box.min[axis] : extent.min[axis];
    const double length = (periodic[axis] ? box.max[axis] : extent.max[axis]) - low;
    const double count = std::clamp(std::floor(length / (cell_m * cell_margin)), 1.0, most_cells);
    origin_[axis] = low;
    count_[axis] = static_cast<std::int64_t>(count);
    inverse_size_[axis] = count / (periodic[axis] ? length : std::max(length, cell_m * cell_margin));
    cells *= static_cast<std::uint64_t>(count_[axis]);
  }
  const std::uint64_t most_buckets = buckets_per_point * members.size() + 64;
  own_buckets_ = cells <= most_buckets;
  bucket_begin_.assign(std::min(cells, most_buckets) + 1, 0);

  std::vector<std::size_t> bucket(members.size());
  for (std::size_t k = 0; k < members.size(); ++k) {
    bucket[k] = bucket_of(cell_of(points[members[k]]));
    ++bucket_begin_[bucket[k] + 1];
  }
  for (std::size_t b = 1; b < bucket_begin_.size(); ++b) bucket_begin_[b] += bucket_begin_[b - 1];
  std::vector<std::int32_t> next(bucket_begin_.begin(), bucket_begin_.end() - 1);
  member_.resize(members.size());
  point_.resize(members.size());
  cell_.resize(members.size());
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto at = next[bucket[k]]++;
    member_[at] = members[k];
    point_[at] = points[members[k]];
    cell_[at] = cell_of(point_[at]);
  }
}

CellGrid::Cell CellGrid::cell_of(const Vec3& p) const {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double c = std::floor((p[axis] - origin_[axis]) * inverse_size_[axis]);
    // A point on the upper face belongs to the last cell; places far outside are clamped two cells away.
    const double top = static_cast<double>(count_[axis]);
    const bool on_top = c == top && p[axis] - origin_[axis] <= top / inverse_size_[axis] * cell_margin;
    cell[axis] = on_top ? count_[axis] - 1 : static_cast<std::int64_t>(std::clamp(c, -2.0, top + 1));
  }
  return cell;
}

}  // namespace granrad
