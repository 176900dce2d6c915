#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "dem/native/free_rows.h"
#include "dem/native/pair_list.h"
#include "dem/native/wall_contacts.h"

namespace granrad::native {

/// One thread's part of the work: it owns a range of rows. Pairs inside the range are worked on once; a pair
/// across two ranges is worked on by both owners, each adding the force to its own row. Both get the same
/// bits, as the law is exactly antisymmetric.
struct Share {
  WallContacts::Range range{0, 0};
  PairList own, cross;
  WallContacts walls;
  FreeRows rows;
  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> outbox;  ///< [owner] twins of cross pairs
  WorstContact worst;
  bool too_fast[2] = {false, false};  ///< in the last even and the last odd step

  /// Calls visit(a, b, displacement) for every spring kept here: Bed index a with Bed index b > a, or with
  /// wall feature -1 - b.
  template <class Visit>
  void visit_springs(const Rows& rows, Visit visit) const {
    own.visit_springs(rows, false, visit);
    cross.visit_springs(rows, true, visit);
    for (const auto& m : walls.collect()) visit(rows.bed_index[m.row], -1 - m.feature, m.displacement);
  }
  bool owns(std::int64_t row) const { return row >= range.begin && row < range.end; }
};

}  // namespace granrad::native
