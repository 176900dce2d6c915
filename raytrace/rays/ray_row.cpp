#include "raytrace/rays/ray_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

constexpr double bytes_per_pair = 100;     // counts, one-way estimates, and twice as many closed values
constexpr double bytes_per_surface = 600;  // tree, tallies, rows

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

std::int64_t Thinning::kept(std::int32_t i, std::int32_t j, std::int64_t hits) const {
  if (hits >= unit_) return hits;
  const auto [low, high] = std::minmax(i, j);
  const double draw =
      random_uniform2(seed_, static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high))[0];
  return draw * static_cast<double>(unit_) < static_cast<double>(hits) ? unit_ : 0;
}

bool pairs_may_outgrow(const std::vector<std::int64_t>& rays, std::size_t limit_bytes) {
  constexpr double fewest_pairs = 16;
  const double surfaces = static_cast<double>(rays.size()), limit = static_cast<double>(limit_bytes);
  const double least = surfaces * (bytes_per_surface + fewest_pairs * bytes_per_pair);
  if (limit < least)
    throw InputError(advised(fmt::format("memory = {:.3g} MiB ({} surfaces need at least {:.3g} MiB)",
                                         limit * 0x1p-20, rays.size(), least * 0x1p-20),
                             "allow more"));
  double pairs = 0;
  for (const std::int64_t n : rays) pairs += std::min(static_cast<double>(n), surfaces);
  return bytes_per_surface * surfaces + bytes_per_pair * pairs > limit;
}

std::int64_t thinning_unit(const std::vector<TracedRow>& sample, std::size_t surfaces,
                           std::size_t limit_bytes) {
  const double bytes = static_cast<double>(limit_bytes) - bytes_per_surface * static_cast<double>(surfaces);
  const double pairs_per_row = std::max(1.0, bytes / bytes_per_pair / static_cast<double>(surfaces));
  for (std::int64_t unit = 1;; unit *= 2) {
    double kept = 0;
    for (const TracedRow& row : sample)
      for (const HitEntry& e : row.entries)
        kept += std::min(1.0, static_cast<double>(e.hits) / static_cast<double>(unit));
    if (kept <= pairs_per_row * static_cast<double>(sample.size()) || unit > std::int64_t{1} << 40)
      return unit;
  }
}

CountBuilder::CountBuilder(HitCounts& counts, Thinning thinning, int replicates, int of_walls,
                           double stated_density)
    : counts_(counts),
      thinning_(thinning),
      replicates_(replicates),
      of_walls_(of_walls),
      walls_(counts.area_m2.size() - static_cast<std::size_t>(counts.spheres)),
      stated_density_(stated_density) {
  constexpr int enough = 16;  // the error of a pair is then known to a fifth
  constexpr std::size_t most_walls = 200;
  counts_.pattern.row_begin.assign(1, 0);
  counts_.thinning_unit = thinning_.unit();
  if (of_walls_ >= enough && walls_ <= most_walls) counts_.wall_variance_factor.assign(walls_ * walls_, 1);
}

void CountBuilder::append(const TracedRow& row) {
  const auto i = static_cast<std::int32_t>(counts_.launched.size());
  const double area = counts_.area_m2[static_cast<std::size_t>(i)];
  if (replicates_ > 1) {
    const double density = area > 0 ? static_cast<double>(row.launched) / area : 0;
    if (i < counts_.spheres && density > 0)
      sum_.add(row.stated, row.launched, replicates_, density / (density + stated_density_));
    const int replicates = i < counts_.spheres ? replicates_ : of_walls_;
    for (const HitEntry& e : row.entries) {
      table_[pair_kind(counts_.spheres, i, e.surface)].add(e, row.launched, replicates);
      if (i >= counts_.spheres && e.surface >= counts_.spheres) add_pair_of_walls(i, e, row.launched);
    }
  }
  for (const HitEntry& e : row.entries) {
    const std::int64_t hits = thinning_.kept(i, e.surface, e.hits);
    if (hits == 0) continue;
    counts_.pattern.column.push_back(e.surface);
    counts_.hits.push_back(hits);
  }
  counts_.pattern.row_begin.push_back(static_cast<std::int64_t>(counts_.hits.size()));
  counts_.launched.push_back(row.launched);
  counts_.leaked += row.leaked;
  if (!counts_.parts.empty())
    for (const TracedRow::Part& part : row.parts)
      counts_.parts[static_cast<std::size_t>(part.replicate)].push_back({i, part.surface, part.hits});
  if (row.chords == 0) return;
  const double n = static_cast<double>(row.chords), mean = row.chord_sum_m / n;
  area_ += area;
  chord_ += area * mean;
  chord_variance_ += area * area * std::max(0.0, row.chord_square_sum_m2 / n - mean * mean) / n;
}

void CountBuilder::finish() {
  if (area_ > 0) {
    counts_.mean_chord_m = chord_ / area_;
    counts_.mean_chord_error_m = std::sqrt(chord_variance_) / area_;
  }
  counts_.sum_variance_factor = sum_.factor();
  for (std::size_t kind = 0; kind < table_.size(); ++kind) {
    auto& factor = counts_.variance_factor[kind];
    factor = table_[kind].factors();
    if (thinning_.unit() == 1) continue;
    // A pair that stands for many rare ones: its count is `unit` or nothing, the same for both directions.
    const auto bin =
        static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(thinning_.unit()))) - 1;
    if (factor.size() < bin + 2) factor.resize(bin + 2, factor.empty() ? 1 : factor.back());
    factor[bin] = 2 * static_cast<double>(thinning_.unit());
  }
}

void CountBuilder::add_pair_of_walls(std::int32_t i, const HitEntry& e, std::int64_t launched) {
  const double k = static_cast<double>(e.hits), r = of_walls_;
  const double binomial = k * (1 - k / static_cast<double>(launched));
  if (counts_.wall_variance_factor.empty() || !(binomial > 0)) return;
  const auto a = static_cast<std::size_t>(i - counts_.spheres),
             b = static_cast<std::size_t>(e.surface - counts_.spheres);
  const double of_rounding = r / 12;  // however even the set is, counts are whole
  counts_.wall_variance_factor[a * walls_ + b] =
      std::max(r / (r - 1) * (e.replicate_square_sum - k * k / r), of_rounding) / binomial;
}

}  // namespace granrad
