#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "dem/base/aligned.h"
#include "dem/native/contact_columns.h"
#include "dem/native/grid.h"
#include "dem/native/kernels.h"
#include "dem/native/rows.h"
#include "dem/native/spring_columns.h"
#include "dem/native/touch_sums.h"

namespace granrad::native {

/// Memories by row, for the first refresh after the rows were renumbered: each spring under both partners.
class MemoryTable {
 public:
  void build(const std::vector<Memory>& memories, const Rows& rows);
  /// Spring between rows i and j as i sees it, or zero.
  Vec3 find(std::int32_t i, std::int32_t j) const;

 private:
  struct Entry {
    std::int32_t other;
    Vec3 displacement;
  };
  std::vector<std::int64_t> begin_;
  std::vector<Entry> entries_;
};

/// The pairs one thread works on, in two lists. Near: gap below a skin, found with the grid, kept while
/// nobody has moved through the skin (a Verlet list). Tight: those of the near list that can touch before the next refresh;
/// only these are visited each step, and they carry the springs. In each block of the tight list those with a
/// spring come first: behind them whole packs touch nothing.
class PairList {
 public:
  void clear_near() { near_i_.clear(), near_j_.clear(), backward_.clear(); }
  void add_near(std::int32_t i, std::int32_t j);
  /// Appends the partners found[0, count) of row i; returns where to write the next ones.
  void add_near(std::int32_t i, const std::int32_t* found, std::int64_t count);
  /// Pads with the idle rows; call when all near pairs are in.
  void finish_near(std::int32_t idle_row);

  /// Raises closing[row] to the speed, m/s, at which a row that may be met soon (by the reaches in the rows)
  /// approaches or leaves; of both rows, or of the first only.
  void find_closing_speeds(const Kernels& kernels, const RowView& rows, const StepConstants& constants,
                           bool first_only, std::vector<double>& closing);
  /// Chooses the tight pairs by the reaches in the rows and carries the springs over, from the list before
  /// or, after finish_near, from `memories`.
  void refresh(const Kernels& kernels, const RowView& rows, const StepConstants& constants,
               const MemoryTable& memories);
  /// Fills the columns of contacts that are not all alike.
  void fill_coefficients(const Rows& rows, const std::vector<Material>& materials);
  ContactView view() { return view(0, padded_); }
  /// The tight contacts in blocks, to be worked on one after the other: no row before settled_before(b) has a
  /// contact in a block behind b.
  std::int64_t blocks() const { return static_cast<std::int64_t>(settled_before_.size()); }
  ContactView view_of(std::int64_t b) { return view(b * block, std::min((b + 1) * block, padded_)); }
  std::int64_t settled_before(std::int64_t b) const { return settled_before_[b]; }

  /// Calls visit(a, b, displacement) for every spring that is not zero, as Bed index a < b sees it. Of pairs
  /// that two threads keep (`twins`), only the one with the lower row first.
  template <class Visit>
  void visit_springs(const Rows& rows, bool twins, Visit visit) const {
    for (std::int64_t k = 0; k < tight_count_; ++k) {
      const Vec3 s = springs_.get(k);
      if (s == Vec3{} || (twins && first_[k] > second_[k])) continue;
      const auto a = rows.bed_index[first_[k]], b = rows.bed_index[second_[k]];
      a < b ? visit(a, b, s) : visit(b, a, Vec3{} - s);
    }
  }

  /// Calls visit(a, b, units) for every recorded touch, Bed index a < b; of twins only the one with the lower row
  /// first.
  template <class Visit>
  void visit_touches(const Rows& rows, bool twins, Visit visit) const {
    const auto tell = [&](std::int32_t i, std::int32_t j, double units) {
      if (units == 0 || (twins && i > j)) return;
      const auto a = rows.bed_index[i], b = rows.bed_index[j];
      visit(std::min(a, b), std::max(a, b), units);
    };
    for (std::size_t k = 0; k < touch_sum_.size(); ++k) tell(first_[k], second_[k], touch_sum_[k]);
    for (const auto& t : left_) tell(t.first, t.second, t.units);
  }
  void clear_touches() { std::fill(touch_sum_.begin(), touch_sum_.end(), 0.0), left_.clear(); }

  /// Calls visit(i, j) for the rows of every tight pair.
  template <class Visit>
  void visit_tight(Visit visit) const {
    for (std::int64_t k = 0; k < tight_count_; ++k) visit(first_[k], second_[k]);
  }

  std::int64_t near_count() const { return near_count_; }
  std::int64_t tight_count() const { return tight_count_; }
  /// Contacts that touch now: tight pairs with a spring.
  std::int64_t touching_count() const;
  /// The rows of the near pairs, padded with idle rows to a multiple of 8.
  const std::int32_t* near_firsts() const { return near_i_.data(); }
  const std::int32_t* near_seconds() const { return near_j_.data(); }
  std::size_t bytes() const;

 private:
  using RowPair = std::pair<std::int32_t, std::int32_t>;

  std::int64_t select(const Kernels& kernels, const RowView& rows, const StepConstants& constants);

  ContactView view(std::int64_t begin, std::int64_t end);
  /// The touches of tight pairs before, carried to where `next_number_` says they stand now.
  void carry_touches(bool recorded);
  void find_settled();

  static constexpr std::int64_t block = 512;  ///< contacts; their rows stay in the first caches

  AlignedVector<std::int32_t> near_i_, near_j_;
  std::vector<RowPair> backward_;  ///< near pairs whose first row is the higher one
  AlignedVector<std::int32_t> found_first_, found_second_, found_number_;  ///< what select found, near order
  AlignedVector<RowOffset> first_, second_;                                ///< tight pairs
  AlignedVector<std::int32_t> number_, next_number_;  ///< of tight pairs in the near list
  AlignedVector<std::int32_t> place_;                 ///< of near pairs in the tight list, or -1
  SpringColumns springs_, next_springs_;
  ContactColumns varied_;
  AlignedVector<double> touch_sum_, next_touch_sum_;  ///< by tight pair; empty: none are recorded
  std::vector<TouchSum> left_;                        ///< of pairs that left the tight list, by rows
  std::vector<std::int64_t> settled_before_;          ///< by block
  std::int64_t near_count_ = 0, tight_count_ = 0, padded_ = 0;
  std::int32_t idle_row_ = 0;
  bool fresh_ = true;  ///< near numbers have changed: springs come from the memories
};

}  // namespace granrad::native
