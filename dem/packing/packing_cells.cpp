#include "dem/packing/packing_cells.h"

#include <algorithm>

namespace granrad {

PackingCells::PackingCells(const PackingBox& where, double reach_m, const std::vector<Vec3>& position)
    : where_(where), next_(position.size(), -1), previous_(position.size(), -1), cell_(position.size(), -1) {
  constexpr double most_cells_per_side = 512;
  const Vec3 size = where.box.size();
  for (int k = 0; k < 3; ++k) {
    count_[k] = static_cast<int>(std::clamp(size[k] / reach_m, 1.0, most_cells_per_side));
    cells_per_m_[k] = count_[k] / size[k];
  }
  first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2], -1);
  for (std::size_t i = 0; i < position.size(); ++i) update(static_cast<int>(i), position[i]);
}

std::array<int, 3> PackingCells::cell_of(const Vec3& p) const {
  std::array<int, 3> c;
  for (int k = 0; k < 3; ++k)
    c[k] = std::clamp(static_cast<int>((p[k] - where_.box.min[k]) * cells_per_m_[k]), 0, count_[k] - 1);
  return c;
}

/// Cells around `at` along one axis, each once; those outside a periodic box are wrapped by the caller.
void PackingCells::range(int axis, int at, int& low, int& high) const {
  low = at - 1, high = at + 1;
  if (!where_.periodic[axis]) {
    low = std::max(low, 0), high = std::min(high, count_[axis] - 1);
  } else if (count_[axis] < 3) {
    low = 0, high = count_[axis] - 1;
  }
}

void PackingCells::update(int i, const Vec3& position) {
  const auto c = cell_of(position);
  const int cell = index(c[0], c[1], c[2]);
  if (cell == cell_[i]) return;
  if (cell_[i] >= 0) unlink(i);
  link(i, cell);
}

void PackingCells::link(int i, int cell) {
  cell_[i] = cell;
  previous_[i] = -1;
  next_[i] = first_[cell];
  if (next_[i] >= 0) previous_[next_[i]] = i;
  first_[cell] = i;
}

void PackingCells::unlink(int i) {
  if (previous_[i] >= 0)
    next_[previous_[i]] = next_[i];
  else
    first_[cell_[i]] = next_[i];
  if (next_[i] >= 0) previous_[next_[i]] = previous_[i];
}

}  // namespace granrad
