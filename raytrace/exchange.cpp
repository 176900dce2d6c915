#include "raytrace/exchange.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace granrad {

double count_variance_factor(const HitCounts& counts, std::size_t i, std::int64_t k) {
  const auto at = static_cast<std::size_t>(k);
  const auto spheres = static_cast<std::size_t>(counts.spheres);
  const auto to = static_cast<std::size_t>(counts.pattern.column[at]);
  if (i >= spheres && to >= spheres && !counts.wall_variance_factor.empty())
    return counts.wall_variance_factor[(i - spheres) * (counts.launched.size() - spheres) + to - spheres];
  const auto& by_count = counts.variance_factor[pair_kind(counts.spheres, static_cast<std::int32_t>(i),
                                                          counts.pattern.column[at])];
  if (by_count.empty()) return 1;
  const auto hits = static_cast<std::uint64_t>(std::max<std::int64_t>(counts.hits[at], 1));
  return by_count[std::min<std::size_t>(std::bit_width(hits) - 1, by_count.size() - 1)];
}

ExchangeAreas one_way_estimate(const HitCounts& counts) {
  ExchangeAreas estimate;
  estimate.pattern = counts.pattern;
  estimate.area_m2 = counts.area_m2;
  estimate.value.resize(counts.hits.size());
  estimate.variance.resize(counts.hits.size());
  for (std::size_t i = 0; i < counts.launched.size(); ++i) {
    const double n = static_cast<double>(counts.launched[i]), area = counts.area_m2[i];
    estimate.rays_per_m2.push_back(area > 0 ? n / area : 0);
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k) {
      const double hits = static_cast<double>(counts.hits[k]), missed = std::max(1 - hits / n, 0.5 / (n + 1));
      estimate.value[k] = area * hits / n;
      estimate.variance[k] = area * area * hits / (n * n) * missed * count_variance_factor(counts, i, k);
    }
  }
  return estimate;
}

ReplicateSamples replicate_samples(const HitCounts& counts) {
  const double replicates = static_cast<double>(counts.parts.size());
  const auto density = [&](std::size_t s) {
    return counts.area_m2[s] > 0 ? static_cast<double>(counts.launched[s]) / counts.area_m2[s] : 0;
  };
  ReplicateSamples samples;
  for (const auto& part : counts.parts) {
    auto& found = samples.emplace_back();
    found.reserve(part.size());
    for (const auto& [from, to, hits] : part) {
      const auto i = static_cast<std::size_t>(from), j = static_cast<std::size_t>(to);
      const double share = i == j ? 0.5 : density(i) / (density(i) + density(j));
      const double x = counts.area_m2[i] * hits * replicates / static_cast<double>(counts.launched[i]);
      found.push_back({from, to, static_cast<float>(share * x)});
    }
  }
  return samples;
}

ExchangeAreas restricted(const ExchangeAreas& all, const std::vector<std::int32_t>& kept) {
  if (kept.size() == all.area_m2.size()) return all;
  std::vector<std::int32_t> number(all.area_m2.size(), -1);
  for (std::size_t k = 0; k < kept.size(); ++k) number[kept[k]] = static_cast<std::int32_t>(k);
  ExchangeAreas part;
  part.pattern.row_begin = {0};
  for (const auto s : kept) {
    for (auto k = all.pattern.row_begin[s]; k < all.pattern.row_begin[s + 1]; ++k) {
      const auto column = number[all.pattern.column[k]];
      if (column < 0) continue;
      part.pattern.column.push_back(column);
      part.value.push_back(all.value[k]);
      if (!all.variance.empty()) part.variance.push_back(all.variance[k]);
    }
    part.pattern.row_begin.push_back(static_cast<std::int64_t>(part.pattern.column.size()));
    part.area_m2.push_back(all.area_m2[s]);
    if (!all.rays_per_m2.empty()) part.rays_per_m2.push_back(all.rays_per_m2[s]);
  }
  return part;
}

std::vector<double> zero_hit_bound(const HitCounts& counts) {
  const double thinned = counts.thinning_unit > 1 ? 2 * static_cast<double>(counts.thinning_unit) : 0;
  const double expected = -std::log(0.01) + thinned;
  const auto lines_together = [&](std::int64_t ends) {
    return counts.directions > 0 ? static_cast<double>(ends) / (8.0 * static_cast<double>(counts.directions))
                                 : 0;
  };
  std::int64_t most_ends = 0;  // of a sphere: a wall meets no more lines together with one
  for (std::int32_t s = 0; s < counts.spheres; ++s)
    most_ends = std::max(most_ends, counts.launched[static_cast<std::size_t>(s)]);
  std::vector<double> bound;
  for (const std::int64_t n : counts.launched) {
    const double together = std::max(1.0, lines_together(std::min(n, most_ends)));
    bound.push_back(n > 0 ? std::min(1.0, expected * together / static_cast<double>(n)) : 1);
  }
  return bound;
}

SparsePattern symmetrized(const SparsePattern& pattern) {
  const std::size_t n = pattern.row_begin.size() - 1;
  // The transpose, rows ascending because sources are visited in ascending order.
  std::vector<std::int64_t> begin(n + 1, 0);
  for (const std::int32_t j : pattern.column) ++begin[static_cast<std::size_t>(j) + 1];
  for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
  std::vector<std::int32_t> source(pattern.column.size());
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k)
      source[next[pattern.column[k]]++] = static_cast<std::int32_t>(i);

  const auto row = [&](std::size_t i) { return pattern.column.begin() + pattern.row_begin[i]; };
  SparsePattern both;
  both.row_begin.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {  // count first: the union may be large
    auto a = row(i), a_end = row(i + 1);
    auto b = source.begin() + begin[i], b_end = source.begin() + begin[i + 1];
    std::int64_t size = 0;
    for (; a != a_end || b != b_end; ++size) {
      const bool take_a = b == b_end || (a != a_end && *a <= *b),
                 take_b = a == a_end || (b != b_end && *b <= *a);
      a += take_a;
      b += take_b;
    }
    both.row_begin[i + 1] = both.row_begin[i] + size;
  }
  both.column.resize(static_cast<std::size_t>(both.row_begin[n]));
#pragma omp parallel for schedule(static) if (both.column.size() > 100000)
  for (std::size_t i = 0; i < n; ++i)
    std::set_union(row(i), row(i + 1), source.begin() + begin[i], source.begin() + begin[i + 1],
                   both.column.begin() + both.row_begin[i]);
  return both;
}

}  // namespace granrad
