#include "raytrace/rays/ray_row.h"

#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

/// A row without its entries and parts.
struct Head {
  std::size_t place, entries, parts;
  TracedRow row_without_entries() const {
    TracedRow row;
    row.launched = launched, row.leaked = leaked, row.chords = chords;
    row.chord_sum_m = chord_sum_m, row.chord_square_sum_m2 = chord_square_sum_m2;
    row.stated = stated;
    return row;
  }
  std::int64_t launched, leaked, chords;
  double chord_sum_m, chord_square_sum_m2;
  HitEntry stated;
};

}  // namespace

void share_rows(std::vector<TracedRow>& rows, const std::vector<std::size_t>& mine) {
  if (rank_count() == 1) return;
  std::vector<Head> heads;
  std::vector<HitEntry> entries;
  std::vector<TracedRow::Part> parts;
  for (const std::size_t k : mine) {
    const TracedRow& row = rows[k];
    heads.push_back({k, row.entries.size(), row.parts.size(), row.launched, row.leaked, row.chords,
                     row.chord_sum_m, row.chord_square_sum_m2, row.stated});
    entries.insert(entries.end(), row.entries.begin(), row.entries.end());
    parts.insert(parts.end(), row.parts.begin(), row.parts.end());
  }
  const std::vector<HitEntry> all = joined_over_ranks(entries);
  const std::vector<TracedRow::Part> all_parts = joined_over_ranks(parts);
  auto from = all.begin();
  auto part = all_parts.begin();
  for (const Head& head : joined_over_ranks(heads)) {
    TracedRow& row = rows[head.place] = head.row_without_entries();
    row.entries.assign(from, from + static_cast<std::ptrdiff_t>(head.entries));
    from += static_cast<std::ptrdiff_t>(head.entries);
    row.parts.assign(part, part + static_cast<std::ptrdiff_t>(head.parts));
    part += static_cast<std::ptrdiff_t>(head.parts);
  }
}

}  // namespace granrad
