#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/base/aligned.h"
#include "dem/bed/bed.h"
#include "dem/native/kernels.h"

namespace granrad::native {

/// The particles in the engine's order: neighbours in space are neighbours in memory. Behind the last row
/// stand two idle rows for each thread, far apart, which pad the contact lists.
struct Rows {
  std::int64_t count = 0;
  AlignedVector<double> position, velocity, kick, reference;  ///< see RowView and MoveConstants
  AlignedVector<std::int64_t> force;
  AlignedVector<MixedRow> mixed;        ///< empty in double precision
  std::vector<std::int32_t> bed_index;  ///< row -> index in the Bed
  std::vector<std::int32_t> row_of;     ///< index in the Bed -> row
  std::vector<double> radius, mass;     ///< by row
  std::vector<FixedScales> scales;      ///< by row, see make_model
  std::vector<std::int32_t> material;   ///< by row
  bool uniform = true;                  ///< one radius, one material, no rolling friction

  RowView view() {
    return {position.data(), velocity.data(), force.data(), mixed.empty() ? nullptr : mixed.data()};
  }
  /// Brings `mixed` up to date in rows [begin, end), if there is one.
  void fill_mixed(std::int64_t begin, std::int64_t end);
  Vec3 position_of(std::int64_t i) const {
    return {position[4 * i], position[4 * i + 1], position[4 * i + 2]};
  }
  Vec3 velocity_of(std::int64_t i) const {
    return {velocity[8 * i], velocity[8 * i + 1], velocity[8 * i + 2]};
  }
  Vec3 spin_of(std::int64_t i) const {
    return {velocity[8 * i + 4], velocity[8 * i + 5], velocity[8 * i + 6]};
  }
};

/// A tangential spring, free of the order of rows: `first` is a Bed index, `second` a Bed index or -1 -
/// feature.
struct Memory {
  std::int32_t first;
  std::int64_t second;
  Vec3 displacement;
};

/// Periods of the box; zero where not periodic.
struct Periods {
  double length[3]{}, inverse[3]{};
  Vec3 origin{};
  bool any = false;
  explicit Periods(const Bed& bed);
  Vec3 nearest(Vec3 d) const;
  /// The image inside the box.
  Vec3 wrapped(Vec3 p) const;
};

}  // namespace granrad::native
