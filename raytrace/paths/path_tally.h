#pragma once
#include <cstdint>
#include <vector>

namespace granrad {

/// Sums of heats in quanta: wide enough that a quantum may resolve one walk of a millimetre's sphere between plates
/// of kilometres and the sum of all walks still fits.
__extension__ typedef __int128 Quanta;

/// What walks found, in quanta of one power of two: integers, so that no order of walks matters.
struct PathTally {
  std::vector<Quanta> heat;  ///< received by every surface
  std::int64_t segments = 0, lost = 0;

  explicit PathTally(std::size_t surfaces) : heat(surfaces, 0) {}
  void add(const PathTally& other);
  void clear();
};

/// The quantum of a sum of heats that no walk's share exceeds in all (`bound_W`), when the finest heat of one walk is
/// `finest_W`: a power of two, so that quanta become doubles without loss. 2^-50 of the bound, less where a walk would
/// have under 2^12 of them. Throws NumericalError when the range of both is beyond the integers.
double heat_quantum_W(double bound_W, double finest_W);

}  // namespace granrad
