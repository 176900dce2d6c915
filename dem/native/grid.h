#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/native/rows.h"

namespace granrad::native {

/// Cells of at least `cell_m` over the particles, the longest direction slowest (a period counts half), so
/// that threads meet at small faces. Sorting the rows by cell makes the particles of a column segment
/// contiguous.
class Grid {
 public:
  /// Order of the rows (row -> old row) that sorts them by cell.
  std::vector<std::int32_t> sort(const Rows& rows, const Periods& periods, const Box& box, double cell_m,
                                 int threads);
  /// Rows of the neighbouring column segments of the cell of row i that stand behind row i (half of all
  /// neighbours): calls visit(begin, end) for up to five ranges.
  template <class Visit>
  void ranges_behind(std::int64_t i, Visit visit) const {
    const int key = key_of_row_[i], c = key % count_[2], b = key / count_[2] % count_[1],
              a = key / count_[2] / count_[1];
    forward(a, b, c, static_cast<std::int32_t>(i) + 1, visit);
  }
  /// Rows that may stand within `reach_m` of p (of its images where periodic), when sorted: visit(begin,
  /// end), each row once.
  template <class Visit>
  void ranges_about(const Vec3& p, double reach_m, Visit visit) const {
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) cells_about(k, p[axis_[k]], reach_m, low[k], high[k]);
    const auto wrapped = [&](int k, int c) {
      return c < 0 ? c + count_[k] : c < count_[k] ? c : c - count_[k];
    };
    const auto cells = [&](int a, int b, int from, int to) {
      if (from <= to) visit(begin_of(a, b, from), begin_of(a, b, to) + length_of(a, b, to));
    };
    for (int i = low[0]; i <= high[0]; ++i)
      for (int j = low[1]; j <= high[1]; ++j) {
        const int a = wrapped(0, i), b = wrapped(1, j), n = count_[2];
        cells(a, b, std::max(low[2], 0), std::min(high[2], n - 1));
        cells(a, b, std::max(low[2] + n, 0), n - 1);
        cells(a, b, 0, high[2] - n);
      }
  }
  /// Rows whose centre stood in the cells touching the box when sorted: visit(begin, end).
  template <class Visit>
  void ranges_in(const Box& box, Visit visit) const {
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = cell_at(k, box.min[axis_[k]]), high[k] = cell_at(k, box.max[axis_[k]]);
      if (periodic_[k]) low[k] = 0, high[k] = count_[k] - 1;
    }
    for (int a = low[0]; a <= high[0]; ++a)
      for (int b = low[1]; b <= high[1]; ++b)
        visit(begin_of(a, b, low[2]), begin_of(a, b, high[2]) + length_of(a, b, high[2]));
  }

 private:
  int cell_at(int k, double x) const;
  /// Cells within reach of x along axis k; beyond the ends where periodic, but never all round twice.
  void cells_about(int k, double x, double reach, int& low, int& high) const;
  std::int32_t begin_of(int a, int b, int c) const { return begin_[(a * count_[1] + b) * count_[2] + c]; }
  std::int32_t length_of(int a, int b, int c) const {
    const int key = (a * count_[1] + b) * count_[2] + c;
    return begin_[key + 1] - begin_[key];
  }
  void fit(const Rows& rows, const Periods& periods, const Box& box, double cell_m);

  /// Column (a, b), segment c-1 .. c+1, split in two where a period is crossed.
  template <class Visit>
  void segment(int a, int b, int c, Visit visit) const {
    for (int k = 0; k < 2; ++k) {
      int& n = k == 0 ? a : b;
      if (n >= 0 && n < count_[k]) continue;
      if (!periodic_[k]) return;
      n = (n + count_[k]) % count_[k];
    }
    const int last = count_[2] - 1;
    if (c > 0 && c < last)
      return visit(begin_of(a, b, c - 1), begin_of(a, b, c + 1) + length_of(a, b, c + 1));
    visit(begin_of(a, b, c > 0 ? c - 1 : 0),
          begin_of(a, b, c < last ? c + 1 : last) + length_of(a, b, c < last ? c + 1 : last));
    if (!periodic_[2] || last == 0) return;
    if (c == 0) visit(begin_of(a, b, last), begin_of(a, b, last) + length_of(a, b, last));
    if (c == last) visit(begin_of(a, b, 0), begin_of(a, b, 0) + length_of(a, b, 0));
  }
  template <class Visit>
  void forward(int a, int b, int c, std::int32_t behind, Visit visit) const {
    const int last = count_[2] - 1;
    visit(behind, begin_of(a, b, c) + length_of(a, b, c));
    if (c < last) visit(begin_of(a, b, c + 1), begin_of(a, b, c + 1) + length_of(a, b, c + 1));
    if (c == last && last > 0 && periodic_[2])
      visit(begin_of(a, b, 0), begin_of(a, b, 0) + length_of(a, b, 0));
    if (count_[1] > 1) segment(a, b + 1, c, visit);
    if (count_[0] == 1) return;
    segment(a + 1, b, c, visit);
    if (count_[1] == 1) return;
    segment(a + 1, b - 1, c, visit), segment(a + 1, b + 1, c, visit);
  }

  int axis_[3]{0, 1, 2};  ///< slowest to fastest
  int count_[3]{1, 1, 1};
  bool periodic_[3]{};
  double origin_[3]{}, inverse_size_[3]{}, length_[3]{};
  std::vector<std::int32_t> key_of_row_, begin_;
};

}  // namespace granrad::native
