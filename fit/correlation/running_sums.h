#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace granrad {

/// Sums over all cells below and including (x, y, z); zeros at the low border.
class RunningSums {
 public:
  RunningSums(const std::vector<double>& value, const std::array<int, 3>& count)
      : nx_(count[0] + 1), ny_(count[1] + 1) {
    sum_.assign(static_cast<std::size_t>(nx_) * ny_ * (count[2] + 1), 0);
    std::size_t k = 0;
    for (int z = 1; z <= count[2]; ++z)
      for (int y = 1; y <= count[1]; ++y)
        for (int x = 1; x <= count[0]; ++x)
          sum_[place(x, y, z)] = value[k++] + at(x - 1, y, z) + at(x, y - 1, z) + at(x, y, z - 1) -
                                 at(x - 1, y - 1, z) - at(x - 1, y, z - 1) - at(x, y - 1, z - 1) +
                                 at(x - 1, y - 1, z - 1);
  }
  /// Over the cells low <= c < high.
  double over(const std::array<int, 3>& l, const std::array<int, 3>& h) const {
    return at(h[0], h[1], h[2]) - at(l[0], h[1], h[2]) - at(h[0], l[1], h[2]) - at(h[0], h[1], l[2]) +
           at(l[0], l[1], h[2]) + at(l[0], h[1], l[2]) + at(h[0], l[1], l[2]) - at(l[0], l[1], l[2]);
  }

 private:
  std::size_t place(int x, int y, int z) const { return (static_cast<std::size_t>(z) * ny_ + y) * nx_ + x; }
  double at(int x, int y, int z) const { return sum_[place(x, y, z)]; }
  int nx_, ny_;
  std::vector<double> sum_;
};

}  // namespace granrad
