#pragma once
#include <cstdint>
#include <vector>

#include "dem/native/grid.h"
#include "dem/native/kernels.h"
#include "dem/native/rows.h"
#include "dem/native/share.h"

namespace granrad::native {

/// Half skins of the near lists, m: how far each row may move (beside the mean) while its list holds.
struct Skins {
  std::vector<double> half_m;       ///< [n] by row, at least base_m
  double base_m = 0, widest_m = 0;  ///< shared by the many; the largest

  /// A row in fast flight: its skin is wider than that of the many, so that it does not end their list.
  bool flies(std::int64_t row) const { return half_m[row] > base_m; }
};

/// Finds the pairs with a gap below the sum of their half skins and `gap_m`, on the grid that sorted the
/// rows, in single precision (reaches are widened by its rounding). The many search the cells behind them;
/// rows in fast flight are left out of that and search as far as they need.
class NearSearch {
 public:
  NearSearch(const Kernels& kernels, const Grid& grid, const Rows& rows, const Periods& periods,
             const Skins& skins, double gap_m);
  /// Deals the rows out and fills the near lists of all shares.
  void fill(std::vector<Share>& shares) const;

 private:
  using Found = std::vector<std::int32_t>;
  void search_behind(std::vector<Share>& shares, Share& share, std::int64_t row, Found& found) const;
  void search_about(std::vector<Share>& shares, Share& share, std::int64_t row, Found& found) const;
  std::int64_t close_rows(const std::vector<float>& reach, std::int64_t row, float own_reach,
                          std::int32_t begin, std::int32_t end, Found& found) const;
  void add(std::vector<Share>& shares, Share& share, std::int32_t row, std::int32_t other) const;

  const Kernels& kernels_;
  const Grid& grid_;
  const Rows& rows_;
  const Skins& skins_;
  std::vector<float> coordinate_[3], reach_;
  std::vector<float> listed_reach_;  ///< reach_, but not a number (close to nothing) for rows in fast flight
  float period_[3], inverse_period_[3], largest_reach_ = 0;
};

}  // namespace granrad::native
