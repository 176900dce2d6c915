#include "raytrace/lines/line_counts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/base/random.h"

namespace granrad {

namespace {

constexpr double events_per_block = 32768;  // 128 KiB: sorted in the second-level cache

constexpr int largest_unit = 1 << 30;

/// A number in [0, 1) that belongs to a pair and a round of thinning.
double thinning_draw(std::uint64_t seed, std::size_t i, std::int32_t j, std::uint32_t round) {
  return random_uniform2(seed, 0x7468696e00000000u + round,
                         static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint32_t>(j))[0];
}

}  // namespace

PairCounts::PairCounts(std::vector<char> kind, std::size_t max_pairs, double events, int threads)
    : packing_(kind.size(), events, events_per_block),
      kind_(std::move(kind)),
      blocks_(packing_.blocks()),
      max_pairs_(max_pairs) {
  for (int t = 0; t < threads; ++t) events_.emplace_back(packing_);
}

bool PairCounts::sampled(std::size_t row) const {
  constexpr std::size_t few_surfaces = 2000;
  return kind_.size() < few_surfaces || kind_[row] == 1 || (row * 0x9e3779b97f4a7c15u) >> 60 == 0;
}

void PairCounts::count_events(std::size_t b, Scratch& scratch) {
  auto& [events, room, found, merged] = scratch;
  events.clear();
  for (const PairEvents& of_thread : events_) of_thread.collect(b, events);
  if (!arrived_.empty()) {
    const auto& from_others = arrived_[b - static_cast<std::size_t>(own_blocks().begin)];
    events.insert(events.end(), from_others.begin(), from_others.end());
  }
  if (events.empty()) return;
  sort_events(events, room, packing_.row_bits + packing_.column_bits);

  constexpr PairCount end{~0u, 0};  // after all keys
  found.resize(events.size() + 1);
  std::size_t n = 0;
  PairCount sum{events[0] >> line_run_bits, 0};
  for (const std::uint32_t event : events) {
    found[n] = sum;
    const std::uint32_t key = event >> line_run_bits, before = key == sum.key ? sum.count : 0;
    n += key != sum.key;
    sum = {key, before + line_run_count(event)};
  }
  found[n++] = sum;
  found[n] = end;

  auto& pairs = blocks_[b].pairs;
  pairs.push_back(end);
  merged.resize(pairs.size() + n);
  const PairCount *p = pairs.data(), *q = found.data();
  PairCount* to = merged.data();
  while ((p->key & q->key) != end.key) {
    const std::uint32_t key = std::min(p->key, q->key);
    const bool old = p->key == key, now = q->key == key;
    *to++ = {key, (old ? p->count : 0) + (now ? q->count : 0)};
    p += old, q += now;
  }
  const auto size = static_cast<std::size_t>(to - merged.data());
  if (pairs.capacity() < size + 1) pairs = {}, pairs.reserve(size + size / 4 + 1);
  pairs.assign(merged.data(), to);
}

/// Events of blocks that other ranks keep go there, each block's behind their number.
void PairCounts::send_events() {
  std::vector<std::vector<char>> to;
  std::vector<std::uint32_t> events;
  for (int r = 0; r < rank_count(); ++r) {
    auto& bytes = to.emplace_back();
    if (r == rank()) continue;
    const RankPart theirs = part_of_rank(static_cast<std::int64_t>(blocks_.size()), r);
    for (std::int64_t b = theirs.begin; b < theirs.end; ++b) {
      events.assign(1, 0);
      for (const PairEvents& of_thread : events_) of_thread.collect(static_cast<std::size_t>(b), events);
      events[0] = static_cast<std::uint32_t>(events.size() - 1);
      const auto* begin = reinterpret_cast<const char*>(events.data());
      bytes.insert(bytes.end(), begin, begin + events.size() * sizeof events[0]);
    }
  }
  const RankPart own = own_blocks();
  arrived_.assign(static_cast<std::size_t>(own.end - own.begin), {});
  for (const auto& bytes : exchanged_bytes(to)) {
    const auto* from = reinterpret_cast<const std::uint32_t*>(bytes.data());
    for (std::size_t b = 0; b < arrived_.size() && !bytes.empty(); ++b) {
      arrived_[b].insert(arrived_[b].end(), from + 1, from + 1 + *from);
      from += 1 + *from;
    }
  }
}

/// The sum over threads and ranks; to be called by every thread.
void PairCounts::add_pairs(std::size_t of_thread) {
#pragma omp atomic
  pairs_ += of_thread;
#pragma omp barrier
#pragma omp master
  {
    auto sum = static_cast<std::int64_t>(pairs_);
    sum_over_ranks({&sum, 1});
    pairs_ = static_cast<std::size_t>(sum);
  }
#pragma omp barrier
}

void PairCounts::merge(std::uint64_t seed) {
  Scratch scratch;
  const RankPart own = own_blocks();
#pragma omp master
  {
    pairs_ = 0;
    if (rank_count() > 1) send_events();
  }
#pragma omp barrier
  std::size_t mine = 0;
#pragma omp for schedule(dynamic) nowait
  for (std::int64_t k = own.begin; k < own.end; ++k) {
    const auto b = static_cast<std::size_t>(k);
    count_events(b, scratch);
    mine += blocks_[b].pairs.size();
  }
  add_pairs(mine);
#pragma omp for schedule(static)
  for (std::size_t t = 0; t < events_.size(); ++t) events_[t].clear();
  for (bool first = true;; first = false) {
    const bool too_many = pairs_ > max_pairs_ && unit_ < largest_unit;
#pragma omp barrier
    if (!too_many) return;
#pragma omp single
    {
      if (!first || unit_ == 1) unit_ *= 2;
      ++thinning_round_;
      pairs_ = 0;
    }
    mine = 0;
#pragma omp for schedule(dynamic) nowait
    for (std::int64_t b = own.begin; b < own.end; ++b) mine += thin(static_cast<std::size_t>(b), seed);
    add_pairs(mine);
  }
}

std::size_t PairCounts::thin(std::size_t b, std::uint64_t seed) {
  const auto goes = [&](PairCount& pair) {
    if (pair.count >= static_cast<std::uint32_t>(unit_)) return false;
    const double n = std::exchange(pair.count, unit_);
    return thinning_draw(seed, packing_.row(b, pair.key), packing_.column(pair.key), thinning_round_) *
               unit_ >=
           n;
  };
  auto& pairs = blocks_[b].pairs;
  std::size_t kept = 0;
  for (PairCount pair : pairs)
    if (!goes(pair)) pairs[kept++] = pair;
  pairs.resize(kept);
  return kept;
}

/// Welford's update with the counts of this replicate. A pair met for the first time had none before.
void PairCounts::sample(std::size_t b) {
  const double before = replicates_;
  std::vector<Sample> samples;
  auto known = blocks_[b].samples.cbegin();
  const auto known_end = blocks_[b].samples.cend();
  std::size_t row = 0;
  bool wanted = false;
  for (const PairCount& pair : blocks_[b].pairs) {
    if (const std::size_t at = packing_.row(b, pair.key) + 1; at != row) row = at, wanted = sampled(row - 1);
    if (!wanted) continue;
    while (known != known_end && known->key < pair.key) ++known;
    const bool met = known != known_end && known->key == pair.key;
    const double total = met ? known->total : 0.0, spread = met ? known->spread : 0.0;
    const double deviation = before > 0 ? pair.count - total - total / before : 0;
    samples.push_back(
        {pair.key, pair.count, static_cast<float>(spread + deviation * deviation * before / (before + 1))});
  }
  blocks_[b].samples = std::move(samples);
  constexpr std::size_t most_kept = std::size_t{1} << 24;
  if (pairs_ < most_kept) blocks_[b].ends.push_back(blocks_[b].pairs);
}

/// What was counted from the end of one replicate to the end of the next, of all ranks.
ReplicateSamples PairCounts::replicates() const {
  const auto all = static_cast<std::size_t>(replicates_);
  const RankPart own = own_blocks();
  std::int64_t missing = unit_ > 1;
  for (std::int64_t b = own.begin; b < own.end; ++b)
    missing += blocks_[static_cast<std::size_t>(b)].ends.size() != all;
  if (largest_over_ranks(missing) > 0) return {};
  ReplicateSamples samples(all);
  for (std::size_t r = 0; r < all; ++r) {
    for (std::int64_t b = own.begin; b < own.end; ++b)
      add_replicate(static_cast<std::size_t>(b), r, samples[r]);
    samples[r] = joined_over_ranks(samples[r]);
  }
  return samples;
}

void PairCounts::add_replicate(std::size_t b, std::size_t r, std::vector<ReplicateSample>& samples) const {
  static const std::vector<PairCount> none;
  const auto& before = r > 0 ? blocks_[b].ends[r - 1] : none;
  auto known = before.begin();
  for (const PairCount& pair : blocks_[b].ends[r]) {
    while (known != before.end() && known->key < pair.key) ++known;
    const bool met = known != before.end() && known->key == pair.key;
    if (const std::uint32_t count = pair.count - (met ? known->count : 0); count > 0)
      samples.push_back({static_cast<std::int32_t>(packing_.row(b, pair.key)), packing_.column(pair.key),
                         static_cast<float>(count)});
  }
}

void PairCounts::end_replicate() {
#pragma omp for schedule(dynamic)
  for (std::size_t b = 0; b < blocks_.size(); ++b) sample(b);
#pragma omp single
  ++replicates_;
}

/// Pools of pairs by kind and by the binary order of their count: variance per count, from the replicates.
struct PairCounts::VariancePools {
  static constexpr int orders = 40;
  double variance[3][orders] = {}, count[3][orders] = {};

  static int order(double n) { return std::min(orders - 1, std::ilogb(std::max(1.0, n))); }
  double ratio(int kind, double n) const {
    const int k = order(n);
    return count[kind][k] > 0 ? variance[kind][k] / count[kind][k] : 1;
  }
};

PairCounts::VariancePools PairCounts::pooled_variances() const {
  const double replicates = replicates_;
  VariancePools pools;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (const Sample& s : blocks_[b].samples) {
      const int kind =
          kind_[packing_.row(b, s.key)] + kind_[static_cast<std::size_t>(packing_.column(s.key))];
      const int order = VariancePools::order(s.total);
      pools.variance[kind][order] += s.spread * replicates / (replicates - 1);
      pools.count[kind][order] += s.total;
    }
  return pools;
}

/// Both halves of the symmetric matrix, columns ascending.
struct PairCounts::Expanded {
  struct Cell {
    std::int32_t column;
    std::uint32_t count;
  };
  std::vector<std::int64_t> row_begin;
  std::vector<Cell> cell;
};

/// Rows are visited in order, so that row j collects its smaller columns in order too; pairs are given up on
/// the way.
PairCounts::Expanded PairCounts::expand() {
  const std::size_t n = kind_.size();
  Expanded all{std::vector<std::int64_t>(n + 1, 0), {}};
  std::vector<std::int64_t> below(n, 0);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (const PairCount& pair : blocks_[b].pairs) {
      const auto i = packing_.row(b, pair.key), j = static_cast<std::size_t>(packing_.column(pair.key));
      ++all.row_begin[i + 1];
      if (i != j) ++below[j];
    }
  for (std::size_t i = 0; i < n; ++i) all.row_begin[i + 1] += all.row_begin[i] + below[i];
  all.cell.resize(static_cast<std::size_t>(all.row_begin[n]));
  std::vector<std::int64_t> above(n);
  for (std::size_t i = 0; i < n; ++i) above[i] = all.row_begin[i] + std::exchange(below[i], all.row_begin[i]);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (const PairCount& pair : blocks_[b].pairs) {
      const std::size_t i = packing_.row(b, pair.key);
      const std::int32_t j = packing_.column(pair.key);
      if (static_cast<std::size_t>(j) == i) {  // its own image, from both ends
        all.cell[static_cast<std::size_t>(above[i]++)] = {j, 2 * pair.count};
        continue;
      }
      all.cell[static_cast<std::size_t>(above[i]++)] = {j, pair.count};
      all.cell[static_cast<std::size_t>(below[static_cast<std::size_t>(j)]++)] = {
          static_cast<std::int32_t>(i), pair.count};
    }
    blocks_[b] = {};
  }
  return all;
}

/// Gives all ranks the blocks of each.
void PairCounts::share_blocks() {
  std::vector<std::size_t> pair_count, sample_count;
  std::vector<PairCount> pairs;
  std::vector<Sample> samples;
  const RankPart own = own_blocks();
  for (std::int64_t b = own.begin; b < own.end; ++b) {
    Block& block = blocks_[static_cast<std::size_t>(b)];
    pair_count.push_back(block.pairs.size());
    sample_count.push_back(block.samples.size());
    pairs.insert(pairs.end(), block.pairs.begin(), block.pairs.end());
    samples.insert(samples.end(), block.samples.begin(), block.samples.end());
    block = {};
  }
  pair_count = joined_over_ranks(pair_count), sample_count = joined_over_ranks(sample_count);
  pairs = joined_over_ranks(pairs), samples = joined_over_ranks(samples);
  auto pair = pairs.begin();
  auto sample = samples.begin();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].pairs.assign(pair, pair + static_cast<std::ptrdiff_t>(pair_count[b]));
    blocks_[b].samples.assign(sample, sample + static_cast<std::ptrdiff_t>(sample_count[b]));
    pair += static_cast<std::ptrdiff_t>(pair_count[b]);
    sample += static_cast<std::ptrdiff_t>(sample_count[b]);
  }
}

SymmetricCounts PairCounts::finish() {
  events_.clear();
  arrived_.clear();
  SymmetricCounts sum;
  sum.replicates = replicates();
  for (Block& block : blocks_) block.ends.clear();
  if (rank_count() > 1) share_blocks();
  const VariancePools pools = pooled_variances();
  Expanded all = expand();
  sum.thinning_unit = unit_;
  sum.pattern.row_begin = std::move(all.row_begin);
  sum.pattern.column.reserve(all.cell.size());
  sum.count.reserve(all.cell.size());
  sum.variance.reserve(all.cell.size());
  for (std::size_t i = 0; i < kind_.size(); ++i)
    for (auto k = sum.pattern.row_begin[i]; k < sum.pattern.row_begin[i + 1]; ++k) {
      const auto [column, count] = all.cell[static_cast<std::size_t>(k)];
      sum.pattern.column.push_back(column);
      sum.count.push_back(count);
      sum.variance.push_back(count * pools.ratio(kind_[i] + kind_[static_cast<std::size_t>(column)], count));
    }
  return sum;
}

}  // namespace granrad
