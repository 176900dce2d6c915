#include "dem/native/free_rows.h"

#include <cmath>

namespace granrad::native {
namespace {

/// Whether `steps` kicks of gravity alone keep row i within its speed limit, with room for their rounding.
bool stays_in_limit(const Rows& rows, std::int64_t i, const MoveConstants& move, std::int64_t steps) {
  for (int a = 0; a < 3; ++a) {
    const double change = std::abs(move.gravity_kick[a]) * double(steps);
    if (change == 0) continue;
    const double rounding = 1e-15 * double(steps) * (std::abs(rows.velocity[8 * i + a]) + change);
    if (!(change + rounding < rows.reference[4 * i + 3])) return false;
  }
  return true;
}

}  // namespace

void FreeRows::choose(WallContacts::Range range, const PairList& own, const PairList& cross,
                      const WallContacts& walls, const Rows& rows, const MoveConstants& move,
                      std::int64_t steps) {
  is_bound_.assign(range.end - range.begin, 0);
  const auto bind = [&](std::int32_t row) { is_bound_[row - range.begin] = 1; };
  own.visit_tight([&](std::int32_t i, std::int32_t j) { bind(i), bind(j); });
  cross.visit_tight([&](std::int32_t i, std::int32_t) { bind(i); });
  walls.visit_rows(bind);
  bound_.clear(), free_.clear(), bound_before_.clear();
  begin_ = range.begin;
  for (auto i = range.begin; i < range.end; ++i) {
    const bool bound = is_bound_[i - range.begin] || !stays_in_limit(rows, i, move, steps);
    bound_before_.push_back(static_cast<std::int32_t>(bound_.size()));
    (bound ? bound_ : free_).push_back(static_cast<std::int32_t>(i));
  }
  bound_before_.push_back(static_cast<std::int32_t>(bound_.size()));
}

}  // namespace granrad::native
