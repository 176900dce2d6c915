#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/embree/embree_tracer.h"

namespace granrad {

/// Sums of heats in quanta: wide enough that a quantum may resolve one walk of a millimetre's sphere between plates
/// of kilometres and the sum of all walks still fits.
__extension__ typedef __int128 Quanta;

/// Sums over walks of the heat that walls give by a walk (x) and by its clear flight (y), in units of which a walk has few
/// thousands.
struct WalkMoments {
  std::int64_t walks = 0, x = 0, y = 0, xy = 0, yy = 0;

  void add(std::int64_t of_walk, std::int64_t of_flight) {
    ++walks, x += of_walk, y += of_flight, xy += of_walk * of_flight, yy += of_flight * of_flight;
  }
  void add(const WalkMoments& other) {
    walks += other.walks, x += other.x, y += other.y, xy += other.xy, yy += other.yy;
  }
};

/// What walks found, in quanta of one power of two: integers, so that no order of walks matters.
struct PathTally {
  std::vector<Quanta> heat;  ///< received by every surface
  std::vector<Quanta>
      clear_heat;  ///< the same by clear flights, what is expected of them taken off; empty: none
  WalkMoments moments;
  std::int32_t start = 0;  ///< of the walk under way
  double given_W = 0;      ///< by walls, of the walk under way
  EmbreeTracer::Crossed crossed;
  std::int64_t segments = 0, lost = 0;

  PathTally(std::size_t surfaces, bool clear_flights)
      : heat(surfaces, 0), clear_heat(clear_flights ? surfaces : 0, 0) {}
  void add(const PathTally& other);
  void clear();
};

/// The quantum of a sum of heats that no walk's share exceeds in all (`bound_W`), when the finest heat of one walk is
/// `finest_W`: a power of two, so that quanta become doubles without loss. 2^-50 of the bound, less where a walk would
/// have under 2^12 of them. Throws NumericalError when the range of both is beyond the integers.
double heat_quantum_W(double bound_W, double finest_W);

}  // namespace granrad
