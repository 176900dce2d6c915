#include "dem/native/touch_sums.h"

#include <algorithm>

namespace granrad::native {

/// Counting by first, then each row, as rows are short.
template <class Touch>
std::vector<Touch> touch_means(const std::vector<TouchSum>& sums, std::size_t rows, double units_per_m,
                               std::int64_t steps) {
  std::vector<std::size_t> next(rows + 1, 0);
  for (const auto& s : sums) ++next[s.first + 1];
  for (std::size_t i = 0; i < rows; ++i) next[i + 1] += next[i];
  std::vector<TouchSum> sorted(sums.size());
  for (const auto& s : sums) sorted[next[s.first]++] = s;
  std::vector<Touch> means;
  means.reserve(sums.size());
  for (std::size_t begin = 0, end; begin < sorted.size(); begin = end) {
    for (end = begin; end < sorted.size() && sorted[end].first == sorted[begin].first;) ++end;
    std::sort(sorted.begin() + begin, sorted.begin() + end,
              [](const TouchSum& a, const TouchSum& b) { return a.second < b.second; });
    for (std::size_t k = begin; k < end;) {
      const auto second = sorted[k].second;
      double units = 0;
      for (; k < end && sorted[k].second == second; ++k) units += sorted[k].units;
      means.push_back({sorted[begin].first, second, units / (units_per_m * double(steps))});
    }
  }
  return means;
}

template std::vector<PairTouch> touch_means(const std::vector<TouchSum>&, std::size_t, double, std::int64_t);
template std::vector<WallTouch> touch_means(const std::vector<TouchSum>&, std::size_t, double, std::int64_t);

}  // namespace granrad::native
