#include "raytrace/rays/variance_table.h"

#include <bit>
#include <numeric>

namespace granrad {

void VarianceTable::add(const HitEntry& entry, std::int64_t launched, int replicates) {
  const double k = static_cast<double>(entry.hits), r = replicates;
  const double binomial = k * (1 - k / static_cast<double>(launched));
  if (!(binomial > 0)) return;
  Bin& bin = bins_[static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(entry.hits)) - 1)];
  bin.ratio += r * (entry.replicate_square_sum - k * k / r) / binomial;
  bin.freedom += r - 1;
}

std::vector<double> VarianceTable::factors() const {
  constexpr double enough = 60, few = 20;
  const auto freedom_from = [&](std::size_t b) {
    return std::accumulate(bins_.begin() + static_cast<std::ptrdiff_t>(b), bins_.end(), 0.0,
                           [](double sum, const Bin& bin) { return sum + bin.freedom; });
  };
  std::vector<double> factor;
  if (freedom_from(0) < few) return factor;
  Bin group;
  for (std::size_t b = 0; b < bins_.size(); ++b) {
    group.ratio += bins_[b].ratio;
    group.freedom += bins_[b].freedom;
    const bool last = b + 1 == bins_.size();
    if (!last && (group.freedom < enough || freedom_from(b + 1) < enough)) continue;
    factor.resize(b + 1, group.freedom > 0 ? group.ratio / group.freedom : 1);
    group = {};
  }
  while (factor.size() > 1 && factor[factor.size() - 1] == factor[factor.size() - 2]) factor.pop_back();
  return factor;
}

}  // namespace granrad
