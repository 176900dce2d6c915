#pragma once
#include <vector>

#include "dem/bed/bed.h"
#include "dem/native/rows.h"
#include "dem/native/share.h"

namespace granrad::native {

/// Moves the state between the Bed and the rows, and knows what the Bed looked like when the engine left it:
/// an untouched Bed keeps its lists.
class BedTransfer {
 public:
  enum class Change { none, moved, memory, particles };
  /// Loads the Bed; positions are drifted half a step, to where forces are evaluated. Says what differs from
  /// the Bed stored last (the strongest of the changes). Throws InputError for a Bed that makes no sense.
  /// `most_threads`: rows behind the last are made for so many.
  Change load(const Bed& bed, Rows& rows, double half_step_s, int threads, int most_threads);
  /// The memories of the Bed by index, after a load that reported `memory` or `particles`.
  static std::vector<Memory> memories(const Bed& bed);
  /// Writes positions, velocities and springs back. Throws NumericalError for a value that is not a number.
  void store(const Rows& rows, const std::vector<Share>& shares, Bed& bed);
  /// Whether the rows hold this Bed: its particles, where they stand.
  bool holds(const Bed& bed, const Rows& rows) const;
  const std::vector<Material>& materials() const { return materials_; }

 private:
  bool same_particles(const Bed& bed) const;
  void lay_out(const Bed& bed, Rows& rows, int threads);
  void store_springs(const Rows& rows, const std::vector<Share>& shares, Bed& bed);
  std::vector<std::int64_t> id_;
  std::vector<double> radius_;
  std::vector<std::int32_t> material_;
  std::vector<Material> materials_;
  std::vector<ContactMemory> contacts_;
  std::vector<std::int64_t> bucket_;  ///< where the springs of each particle begin in the Bed
};

}  // namespace granrad::native
