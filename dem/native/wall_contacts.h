#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/bed/wall_surface.h"
#include "dem/native/contact_columns.h"
#include "dem/native/grid.h"
#include "dem/native/kernels.h"
#include "dem/native/rows.h"
#include "dem/native/touch_sums.h"

namespace granrad::native {

/// The spring of a row at a wall feature.
struct WallMemory {
  std::int32_t row;
  std::int64_t feature;
  Vec3 displacement;
};

/// The wall contacts of one thread's rows. Most particles meet walls far from edges: there the walls are
/// planes, worked on in packs. Near edges and corners ("border rows") each step asks the surface for the
/// local minima of the distance.
///
/// In periodic directions a particle meets the walls inside the box, at its image there: walls that reach the
/// border of the box must go on straight behind it.
class WallContacts {
 public:
  struct Range {
    std::int64_t begin, end;
  };
  /// Facets within `skin_m[row] + gap_m` of the rows' surfaces. `drift` is how far the rows' mean moved since
  /// the grid was sorted, `slack_m` how far a row may have moved beside it.
  void find_near(const WallSurface& surface, const Grid& grid, const Rows& rows, const Periods& periods,
                 Range range, const std::vector<double>& skin_m, double gap_m, const Vec3& drift,
                 double slack_m);
  /// Raises closing[row] to the speed at which a row that may soon meet a facet approaches its plane.
  void find_closing_speeds(const WallSurface& surface, const Rows& rows, const Periods& periods,
                           double life_s, std::vector<double>& closing) const;
  /// Chooses those that can touch before the next refresh; in `life_s`.
  void refresh(const WallSurface& surface, const Rows& rows, const Periods& periods,
               const std::vector<Material>& materials, const StepConstants& constants, std::int32_t idle_row);
  /// Adds the forces.
  WorstContact add_forces(const Kernels& kernels, const WallSurface& surface, Rows& rows,
                          const Periods& periods, const StepConstants& constants,
                          const std::vector<Material>& materials);

  /// Springs that are not zero, in ascending rows.
  std::vector<WallMemory> collect() const;
  /// Calls visit(Bed index, wall, units) for every recorded touch.
  template <class Visit>
  void visit_touches(const WallSurface& surface, const Rows& rows, Visit visit) const {
    for (std::int64_t k = 0; k < plane_count_ && !touch_sum_.empty(); ++k)
      if (touch_sum_[k] != 0) visit(rows.bed_index[rows_[k]], surface.wall(facets_[k]), touch_sum_[k]);
    for (const auto& t : left_) visit(rows.bed_index[t.first], t.second, t.units);
  }
  void clear_touches() { std::fill(touch_sum_.begin(), touch_sum_.end(), 0.0), left_.clear(); }
  /// Replaces what the next refresh carries over.
  void restore(std::vector<WallMemory> memories) { memories_ = std::move(memories), restored_ = true; }
  struct Near {
    std::int32_t row, facet;
  };
  /// What find_near found, in ascending (row, facet).
  const std::vector<Near>& near() const { return near_; }
  /// Calls visit(row) for every row that may touch a wall before the next refresh, once or more.
  template <class Visit>
  void visit_rows(Visit visit) const {
    for (std::int64_t k = 0; k < plane_count_; ++k) visit(rows_[k]);
    for (const auto& b : borders_) visit(b.row);
  }
  std::int64_t contact_count() const { return plane_count_ + static_cast<std::int64_t>(borders_.size()); }

 private:
  struct Spring {
    std::int64_t feature;
    Vec3 displacement;
  };
  struct Border {
    std::int32_t row;
    std::size_t facets_begin, facets_end;
    std::vector<Spring> springs;
  };
  bool acts_as_planes(const WallSurface& surface, const Periods& periods, const Vec3& p, double margin_m,
                      const std::vector<std::int32_t>& facets) const;
  void add_plane(std::int32_t row, std::int32_t facet, std::int64_t feature, std::vector<WallMemory>& kept);
  void finish_planes(const Rows& rows, const std::vector<Material>& materials, std::int32_t idle_row,
                     std::int32_t idle_plane);
  static std::vector<Spring> carry_springs(const WallSurface& surface,
                                           const std::vector<WallSurface::Touch>& touches,
                                           std::vector<Spring> old);
  static WorstContact add_touch(const WallSurface& surface, Rows& rows, std::int32_t row,
                                const LawCoefficients& law, const StepConstants& constants,
                                const WallSurface::Touch& touch, Vec3& spring);
  void record_touch(const StepConstants& constants, std::int32_t row, std::int32_t wall, double radius,
                    double distance);
  WorstContact border_forces(const WallSurface& surface, Rows& rows, const Periods& periods,
                             const StepConstants& constants, const std::vector<Material>& materials,
                             Border& border);

  std::vector<Near> near_;
  std::vector<Border> borders_;
  std::vector<std::int32_t> border_facets_;
  std::vector<RowOffset> rows_, facets_;  ///< plane contacts
  std::vector<std::int64_t> features_;
  AlignedVector<double> displacement_[3];
  ContactColumns varied_;
  AlignedVector<double> touch_sum_;  ///< by plane contact; empty: none are recorded
  std::vector<TouchSum> left_;       ///< of rows and walls: at edges, and of contacts before
  std::int64_t plane_count_ = 0;
  std::vector<WallMemory> memories_;
  bool restored_ = false;
};

}  // namespace granrad::native
