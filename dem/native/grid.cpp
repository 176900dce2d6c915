#include "dem/native/grid.h"

#include <algorithm>
#include <cmath>

namespace granrad::native {

void Grid::fit(const Rows& rows, const Periods& periods, const Box& box, double cell_m) {
  Vec3 low = box.min, high = box.max;
  for (int a = 0; a < 3; ++a) {
    if (periods.length[a] > 0) continue;
    low[a] = 1e300, high[a] = -1e300;
    for (std::int64_t i = 0; i < rows.count; ++i) {
      low[a] = std::min(low[a], rows.position[4 * i + a]);
      high[a] = std::max(high[a], rows.position[4 * i + a]);
    }
    if (rows.count == 0) low[a] = high[a] = 0;
  }
  const Vec3 extent = high - low;
  axis_[0] = 0, axis_[1] = 1, axis_[2] = 2;
  // Around a period threads meet at two faces.
  const auto worth = [&](int a) { return periods.length[a] > 0 ? 0.5 * extent[a] : extent[a]; };
  std::sort(axis_, axis_ + 3, [&](int a, int b) { return worth(a) > worth(b); });
  for (double size = cell_m;;
       size *= 1.26) {  // far outliers: coarser cells, never more than a few per particle
    double cells = 1;
    for (int k = 0; k < 3; ++k) {
      const double n = std::max(1.0, std::floor(extent[axis_[k]] / size));
      periodic_[k] = periods.length[axis_[k]] > 0;
      cells *= periodic_[k] && n < 3 ? 1 : n;
    }
    if (cells > 8.0 * double(rows.count) + 64) continue;
    for (int k = 0; k < 3; ++k) {
      const int n = std::max(1, static_cast<int>(extent[axis_[k]] / size));
      count_[k] = periodic_[k] && n < 3 ? 1 : n;
      origin_[k] = low[axis_[k]];
      length_[k] = periods.length[axis_[k]];
      const double width = extent[axis_[k]] / count_[k];
      inverse_size_[k] = width > 0 ? 1 / width : 0;
    }
    return;
  }
}

int Grid::cell_at(int k, double x) const {
  double t = x - origin_[k];
  if (periodic_[k]) t -= length_[k] * std::floor(t / length_[k]);
  return static_cast<int>(std::clamp(t * inverse_size_[k], 0.0, count_[k] - 1.0));
}

void Grid::cells_about(int k, double x, double reach, int& low, int& high) const {
  low = cell_at(k, x - reach), high = cell_at(k, x + reach);
  if (!periodic_[k]) return;
  const int across = static_cast<int>(std::ceil(reach * inverse_size_[k])), middle = cell_at(k, x);
  low = middle - across, high = middle + across;
  if (high - low >= count_[k] - 1) low = 0, high = count_[k] - 1;
}

std::vector<std::int32_t> Grid::sort(const Rows& rows, const Periods& periods, const Box& box, double cell_m,
                                     int threads) {
  fit(rows, periods, box, cell_m);
  const std::int64_t n = rows.count;
  std::vector<std::int32_t> key(n), order(n);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::int64_t i = 0; i < n; ++i) {
    int c[3];
    for (int k = 0; k < 3; ++k) c[k] = cell_at(k, rows.position[4 * i + axis_[k]]);
    key[i] = (c[0] * count_[1] + c[1]) * count_[2] + c[2];
  }
  begin_.assign(std::size_t(count_[0]) * count_[1] * count_[2] + 2, 0);
  for (const auto k : key) ++begin_[k + 2];
  for (std::size_t c = 2; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  key_of_row_.resize(n);
  for (std::int64_t i = 0; i < n; ++i) {
    const auto row = begin_[key[i] + 1]++;
    order[row] = static_cast<std::int32_t>(i);
    key_of_row_[row] = key[i];
  }
  begin_.pop_back();
  return order;
}

}  // namespace granrad::native
