#pragma once
#include <cstdint>
#include <vector>

#include "dem/native/kernels.h"
#include "dem/native/pair_list.h"
#include "dem/native/rows.h"
#include "dem/native/wall_contacts.h"

namespace granrad::native {

/// The rows of one thread, in two: bound ones, which are in a tight list or at a wall, and free ones, which
/// nothing can touch while the lists live. No one reads a free row in that time, so that it is moved once, through
/// all the steps the others have done: with the same operations as step by step, but in registers.
class FreeRows {
 public:
  /// Splits the rows of `range` for the next `steps` steps at most. A row that gravity alone would take over its
  /// speed limit in that time counts as bound, as limits are tested there only.
  void choose(WallContacts::Range range, const PairList& own, const PairList& cross,
              const WallContacts& walls, const Rows& rows, const MoveConstants& move, std::int64_t steps);
  const std::vector<std::int32_t>& bound() const { return bound_; }  ///< ascending
  const std::vector<std::int32_t>& free() const { return free_; }
  /// How many bound rows there are before `row` of the range or its end.
  std::int64_t bound_before(std::int64_t row) const { return bound_before_[row - begin_]; }

 private:
  std::vector<std::int32_t> bound_, free_;
  std::vector<std::uint8_t> is_bound_;      ///< by row of the range
  std::vector<std::int32_t> bound_before_;  ///< by row of the range and for its end
  std::int64_t begin_ = 0;                  ///< of the range
};

}  // namespace granrad::native
