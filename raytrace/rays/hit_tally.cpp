#include "raytrace/rays/hit_tally.h"

#include <algorithm>

namespace granrad {

std::int64_t HitTally::hits_on(const std::vector<char>& wanted) const {
  std::int64_t hits = 0;
  for (const std::int32_t s : touched_)
    if (wanted[static_cast<std::size_t>(s)]) hits += current_[static_cast<std::size_t>(s)];
  return hits;
}

void HitTally::end_replicate() {
  for (const std::int32_t s : touched_) {
    const auto k = static_cast<std::size_t>(s);
    if (total_[k] == 0) seen_.push_back(s);
    total_[k] += current_[k];
    square_[k] += static_cast<double>(current_[k]) * current_[k];
    current_[k] = 0;
  }
  touched_.clear();
}

std::vector<HitEntry> HitTally::take() {
  std::sort(seen_.begin(), seen_.end());
  std::vector<HitEntry> entries;
  entries.reserve(seen_.size());
  for (const std::int32_t s : seen_) {
    const auto k = static_cast<std::size_t>(s);
    entries.push_back({s, total_[k], square_[k]});
    total_[k] = 0;
    square_[k] = 0;
  }
  seen_.clear();
  return entries;
}

}  // namespace granrad
