#include "dem/native/near_search.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace granrad::native {
namespace {

constexpr std::int64_t read_beyond = 16;  ///< entries behind the last row that the kernels may read

struct Extent {
  Vec3 low{1e300, 1e300, 1e300};
  double longest = 0;
};

Extent extent_of(const Rows& rows, const Periods& periods) {
  Extent e;
  Vec3 high{-1e300, -1e300, -1e300};
  for (std::int64_t i = 0; i < rows.count; ++i)
    for (int a = 0; a < 3; ++a) {
      e.low[a] = std::min(e.low[a], rows.position[4 * i + a]);
      high[a] = std::max(high[a], rows.position[4 * i + a]);
    }
  for (int a = 0; a < 3; ++a)
    e.longest = std::max(e.longest, periods.length[a] > 0 ? periods.length[a] : high[a] - e.low[a]);
  return e;
}

int owner_of(const std::vector<Share>& shares, std::int64_t rows, std::int64_t row) {
  auto t = static_cast<std::size_t>(row * static_cast<std::int64_t>(shares.size()) / rows);
  while (row >= shares[t].range.end) ++t;
  while (row < shares[t].range.begin) --t;
  return static_cast<int>(t);
}

}  // namespace

NearSearch::NearSearch(const Kernels& kernels, const Grid& grid, const Rows& rows, const Periods& periods,
                       const Skins& skins, double gap_m)
    : kernels_(kernels), grid_(grid), rows_(rows), skins_(skins) {
  const Extent extent = extent_of(rows, periods);
  const double rounding = 1e-6 * extent.longest;
  for (auto& c : coordinate_) c.resize(rows.count + read_beyond);
  reach_.resize(rows.count + read_beyond), listed_reach_.resize(rows.count + read_beyond);
  for (std::int64_t i = 0; i < rows.count; ++i) {
    for (int a = 0; a < 3; ++a) {
      double x = rows.position[4 * i + a] - extent.low[a];
      if (periods.length[a] > 0) x -= periods.length[a] * std::floor(x * periods.inverse[a]);
      coordinate_[a][i] = static_cast<float>(x);
    }
    reach_[i] = static_cast<float>(rows.radius[i] + skins.half_m[i] + 0.5 * gap_m + rounding);
    listed_reach_[i] = skins.flies(i) ? std::numeric_limits<float>::quiet_NaN() : reach_[i];
    largest_reach_ = std::max(largest_reach_, reach_[i]);
  }
  for (int a = 0; a < 3; ++a) {
    period_[a] = static_cast<float>(periods.length[a]);
    inverse_period_[a] = static_cast<float>(periods.inverse[a]);
  }
}

std::int64_t NearSearch::close_rows(const std::vector<float>& reach, std::int64_t row, float own_reach,
                                    std::int32_t begin, std::int32_t end, Found& found) const {
  if (begin >= end) return 0;
  const auto room = static_cast<std::size_t>(end - begin) + 32;
  if (room > found.size()) found.resize(2 * room);
  const float p[4] = {coordinate_[0][row], coordinate_[1][row], coordinate_[2][row], own_reach};
  return kernels_.find_close(&coordinate_[0][begin], &coordinate_[1][begin], &coordinate_[2][begin],
                             &reach[begin], p, period_, inverse_period_, begin, end - begin, found.data());
}

void NearSearch::add(std::vector<Share>& shares, Share& share, std::int32_t row, std::int32_t other) const {
  if (share.owns(other)) return share.own.add_near(row, other);
  share.cross.add_near(row, other);
  share.outbox[owner_of(shares, rows_.count, other)].push_back({other, row});
}

void NearSearch::search_behind(std::vector<Share>& shares, Share& share, std::int64_t i, Found& found) const {
  const auto row = static_cast<std::int32_t>(i);
  grid_.ranges_behind(i, [&](std::int32_t begin, std::int32_t end) {
    const auto count = close_rows(listed_reach_, i, listed_reach_[i], begin, end, found);
    if (begin >= share.range.begin && end <= share.range.end)
      return share.own.add_near(row, found.data(), count);
    for (std::int64_t k = 0; k < count; ++k) add(shares, share, row, found[k]);
  });
}

void NearSearch::search_about(std::vector<Share>& shares, Share& share, std::int64_t i, Found& found) const {
  const auto row = static_cast<std::int32_t>(i);
  grid_.ranges_about(rows_.position_of(i), reach_[i] + largest_reach_,
                     [&](std::int32_t begin, std::int32_t end) {
                       const auto count = close_rows(reach_, i, reach_[i], begin, end, found);
                       for (std::int64_t k = 0; k < count; ++k) {
                         const auto j = found[k];
                         const bool others_find = skins_.flies(j) && j < row;  // each pair once
                         if (j != row && !others_find) add(shares, share, row, j);
                       }
                     });
}

void NearSearch::fill(std::vector<Share>& shares) const {
  const auto threads = static_cast<int>(shares.size());
  const std::int64_t n = rows_.count;
  for (int t = 0; t < threads; ++t) shares[t].range = {n * t / threads, n * (t + 1) / threads};
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num();
    Share& share = shares[t];
    share.own.clear_near(), share.cross.clear_near();
    for (auto& box : share.outbox) box.clear();
    Found found(1024);
    for (auto i = share.range.begin; i < share.range.end; ++i)
      skins_.flies(i) ? search_about(shares, share, i, found) : search_behind(shares, share, i, found);
#pragma omp barrier
    for (const auto& other : shares)
      for (const auto& [i, j] : other.outbox[t]) share.cross.add_near(i, j);
    const auto idle = static_cast<std::int32_t>(n + 2 * t);
    share.own.finish_near(idle), share.cross.finish_near(idle);
  }
}

}  // namespace granrad::native
