#include "raytrace/line_counts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "dem/scene/random.h"

namespace granrad {

namespace {

constexpr std::int32_t free_slot = -1;
constexpr std::size_t first_slots = 16;

std::size_t hash(std::int32_t id) {
  return static_cast<std::uint32_t>(id) * 0x9e3779b1u;
}

/// A number in [0, 1) that belongs to a pair.
double lot(std::uint64_t seed, std::size_t i, std::int32_t j, int unit) {
  return random_uniform2(seed, 0x7468696e00000000u + static_cast<std::uint64_t>(unit),
                         static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint32_t>(j))[0];
}

}  // namespace

PairCounts::PairCounts(std::vector<char> kind, std::size_t max_entries)
    : kind_(std::move(kind)),
      rows_(kind_.size()),
      locks_(new Lock[kind_.size()]),
      max_entries_(max_entries) {}

bool PairCounts::sampled(std::size_t i, std::size_t j) const {
  constexpr std::size_t few_surfaces = 2000;
  if (rows_.size() < few_surfaces || kind_[i] + kind_[j] == 2) return true;
  const std::uint64_t pair = static_cast<std::uint64_t>(std::min(i, j)) << 32 | std::max(i, j);
  return (pair * 0x9e3779b97f4a7c15u) >> 60 == 0;
}

PairCounts::Buffer::Buffer(PairCounts& counts, std::size_t memory_bytes) : counts_(counts) {
  const std::size_t rows = counts.rows_.size(), fair = memory_bytes / sizeof(std::int32_t) / rows;
  bunch_ = static_cast<std::int32_t>(std::clamp<std::size_t>(fair, 48, 1024));
  waiting_.resize(rows * static_cast<std::size_t>(bunch_));
  fill_.assign(rows, 0);
  multiplicity_.assign(rows, 0);
  distinct_.resize(static_cast<std::size_t>(bunch_) + 1);
}

void PairCounts::Buffer::flush(std::size_t row) {
  const std::int32_t* ids = waiting_.data() + row * bunch_;
  std::size_t n = 0;
  for (std::int32_t k = 0; k < fill_[row]; ++k) {
    distinct_[n] = ids[k];
    n += multiplicity_[ids[k]]++ == 0;
  }
  counts_.add(row, distinct_.data(), n, multiplicity_.data());
  fill_[row] = 0;
}

void PairCounts::Buffer::flush() {
  for (std::size_t row = 0; row < fill_.size(); ++row)
    if (fill_[row] > 0) flush(row);
}

PairCounts::Entry& PairCounts::slot(Row& row, std::int32_t id) {
  const std::size_t mask = row.slots.size() - 1;
  std::size_t k = (hash(id) >> 8) & mask;
  while (row.slots[k].id != id && row.slots[k].id != free_slot) k = (k + 1) & mask;
  return row.slots[k];
}

void PairCounts::grow(Row& row) {
  Row larger;
  larger.slots.assign(std::max(first_slots, 2 * row.slots.size()), Entry{free_slot, 0, 0, 0});
  larger.used = row.used;
  for (const Entry& e : row.slots)
    if (e.id != free_slot) slot(larger, e.id) = e;
  row = std::move(larger);
}

void PairCounts::add(std::size_t at, const std::int32_t* ids, std::size_t n, std::int32_t* multiplicity) {
  Lock& lock = locks_[at];
  while (lock.taken.test_and_set(std::memory_order_acquire)) {
  }
  Row& row = rows_[at];
  for (std::size_t k = 0; k < n; ++k) {
    if (4 * (row.used + 1) > 3 * row.slots.size()) grow(row);
    Entry& e = slot(row, ids[k]);
    if (e.id == free_slot) {
      e.id = ids[k];
      ++row.used;
    }
    e.current += std::exchange(multiplicity[ids[k]], 0);
  }
  lock.taken.clear(std::memory_order_release);
}

void PairCounts::keep_within_limit(std::uint64_t seed) {
#pragma omp single
  {
    entries_ = 0;
    for (const Row& row : rows_) entries_ += row.used;
  }
  for (;;) {
    const bool too_many = entries_ > max_entries_;
#pragma omp barrier
    if (!too_many) return;
#pragma omp single
    {
      unit_ *= 2;
      entries_ = 0;
    }
    std::size_t mine = 0;
#pragma omp for schedule(dynamic, 256) nowait
    for (std::size_t i = 0; i < rows_.size(); ++i) mine += thin(i, seed);
#pragma omp atomic
    entries_ += mine;
#pragma omp barrier
  }
}

std::size_t PairCounts::thin(std::size_t i, std::uint64_t seed) {
  std::vector<Entry> survivors;
  for (Entry e : rows_[i].slots) {
    if (e.id == free_slot) continue;
    const std::int64_t n = e.current + static_cast<std::int64_t>(e.total);
    if (n < unit_) {
      if (lot(seed, i, e.id, unit_) * unit_ >= static_cast<double>(n)) continue;
      e.current += static_cast<std::int32_t>(unit_ - n);
    }
    survivors.push_back(e);
  }
  Row kept;
  kept.used = survivors.size();
  if (!survivors.empty())
    kept.slots.assign(std::max(first_slots, std::bit_ceil(survivors.size() * 4 / 3 + 2)),
                      Entry{free_slot, 0, 0, 0});
  for (const Entry& e : survivors) slot(kept, e.id) = e;
  rows_[i] = std::move(kept);
  return survivors.size();
}

const PairCounts::Entry* PairCounts::mirrored(std::size_t i, std::int32_t j) const {
  const Row& row = rows_[static_cast<std::size_t>(j)];
  if (row.slots.empty()) return nullptr;
  const Entry& e = slot(const_cast<Row&>(row), static_cast<std::int32_t>(i));
  return e.id == free_slot ? nullptr : &e;
}

/// Welford's update with the count of this replicate. An entry met for the first time takes over the spread
/// that its mirror image has gathered.
void PairCounts::update_spreads() {
  const double before = replicates_;
#pragma omp for schedule(dynamic, 64)
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (Entry& e : rows_[i].slots) {
      if (e.id == free_slot || !sampled(i, static_cast<std::size_t>(e.id))) continue;
      const Entry* m = mirrored(i, e.id);
      if (e.total == 0 && m && m->total > 0) continue;
      const double current = e.current + (m ? m->current : 0.0), total = e.total + (m ? m->total : 0.0);
      const double deviation = before > 0 ? current - total / before : 0;
      e.spread += static_cast<float>(deviation * deviation * before / (before + 1));
    }
#pragma omp for schedule(dynamic, 64)
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (Entry& e : rows_[i].slots) {
      if (e.id == free_slot || e.total > 0 || !sampled(i, static_cast<std::size_t>(e.id))) continue;
      const Entry* m = mirrored(i, e.id);
      if (m && m->total > 0) e.spread = m->spread;
    }
}

void PairCounts::end_replicate() {
  update_spreads();
#pragma omp for schedule(static)
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (Entry& e : rows_[i].slots) e.total += static_cast<std::uint32_t>(std::exchange(e.current, 0));
#pragma omp single
  ++replicates_;
}

namespace {

/// Pools of pairs by kind and by the binary order of their count: variance per count, from the replicates.
struct VariancePools {
  static constexpr int orders = 40;
  double variance[3][orders] = {}, count[3][orders] = {};

  static int order(double n) { return std::min(orders - 1, std::ilogb(std::max(1.0, n))); }
  double ratio(int kind, double n) const {
    const int k = order(n);
    return count[kind][k] > 0 ? variance[kind][k] / count[kind][k] : 1;
  }
};

struct Cell {
  std::int32_t column;
  std::uint32_t count;
  float variance;
};

struct Rows {
  std::vector<std::int64_t> begin;
  std::vector<Cell> cell;
};

/// The transpose; its columns ascend because rows are visited in order.
Rows transposed(const Rows& a) {
  const std::size_t n = a.begin.size() - 1;
  Rows t{std::vector<std::int64_t>(n + 1, 0), std::vector<Cell>(a.cell.size())};
  for (const Cell& c : a.cell) ++t.begin[c.column + 1];
  for (std::size_t i = 0; i < n; ++i) t.begin[i + 1] += t.begin[i];
  std::vector<std::int64_t> next(t.begin.begin(), t.begin.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      t.cell[next[a.cell[k].column]++] = {static_cast<std::int32_t>(i), a.cell[k].count, a.cell[k].variance};
  return t;
}

/// Calls visit(column, count, variance) for every entry of row i of a + b.
template <class Visit>
void merge_row(const Rows& a, const Rows& b, std::size_t i, Visit&& visit) {
  std::int64_t p = a.begin[i], q = b.begin[i];
  const std::int64_t p_end = a.begin[i + 1], q_end = b.begin[i + 1];
  while (p < p_end || q < q_end) {
    const std::int32_t left = p < p_end ? a.cell[p].column : INT32_MAX;
    const std::int32_t right = q < q_end ? b.cell[q].column : INT32_MAX;
    const std::int32_t column = std::min(left, right);
    std::int64_t count = 0;
    double variance = 0;
    if (left == column) count += a.cell[p].count, variance = a.cell[p].variance, ++p;
    if (right == column) count += b.cell[q].count, variance = b.cell[q].variance, ++q;
    visit(column, count, variance);
  }
}

}  // namespace

SymmetricCounts PairCounts::finish() {
  const std::size_t n = rows_.size();
  Rows before{std::vector<std::int64_t>(n + 1, 0), {}};
  for (std::size_t i = 0; i < n; ++i)
    before.begin[i + 1] = before.begin[i] + static_cast<std::int64_t>(rows_[i].used);
  before.cell.resize(static_cast<std::size_t>(before.begin[n]));
  const double replicates = replicates_;
  for (std::size_t i = 0; i < n; ++i) {
    std::int64_t k = before.begin[i];
    for (const Entry& e : rows_[i].slots) {
      if (e.id == free_slot) continue;
      before.cell[k++] = {e.id, e.total, static_cast<float>(e.spread * replicates / (replicates - 1))};
    }
    rows_[i] = Row{};
  }
  const Rows after = transposed(before);
  before = transposed(after);

  VariancePools pools;
  for (std::size_t i = 0; i < n; ++i)
    merge_row(before, after, i, [&](std::int32_t j, std::int64_t count, double variance) {
      if (!sampled(i, static_cast<std::size_t>(j))) return;
      const int pool = kind_[i] + kind_[j], order = VariancePools::order(static_cast<double>(count));
      pools.variance[pool][order] += variance;
      pools.count[pool][order] += static_cast<double>(count);
    });

  SymmetricCounts sum;
  sum.thinning_unit = unit_;
  sum.pattern.row_begin.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    merge_row(before, after, i, [&](std::int32_t, std::int64_t, double) { ++sum.pattern.row_begin[i + 1]; });
    sum.pattern.row_begin[i + 1] += sum.pattern.row_begin[i];
  }
  const auto entries = static_cast<std::size_t>(sum.pattern.row_begin[n]);
  sum.pattern.column.reserve(entries), sum.count.reserve(entries), sum.variance.reserve(entries);
  for (std::size_t i = 0; i < n; ++i)
    merge_row(before, after, i, [&](std::int32_t j, std::int64_t count, double) {
      sum.pattern.column.push_back(j);
      sum.count.push_back(count);
      sum.variance.push_back(count * pools.ratio(kind_[i] + kind_[j], static_cast<double>(count)));
    });
  return sum;
}

}  // namespace granrad
