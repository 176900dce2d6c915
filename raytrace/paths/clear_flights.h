#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/enclosure.h"
#include "raytrace/paths/path_starts.h"

namespace granrad {

/// What first flights between walls and spheres would bring were nothing in their way: known exactly, and much like what
/// they do bring where the bed is thin. Sampled with the same walks and taken out again, it takes noise with it (control
/// variate: Owen, Monte Carlo theory, methods and examples, chapter 8).
///
/// A walk from wall w would meet every sphere i its line crosses, one from i the wall it aims at: the exchange area of the
/// pair without shade is A_i F_iw, F_iw = solid angle of the wall at the centre / 4 pi, for spheres that no wall cuts. Each
/// crossing counts c_wi times what a walk absorbed there would: c = exp(-3/2 kappa h), h the distance of i from the plane
/// of w, kappa = sum pi r^2 / V, about the share that arrives. Any c is unbiased.
///
/// Crossings and hits have the correlation rho^2 = tau / (e^tau - 1) on a line of the depth tau (spheres at random).
class ClearFlights {
 public:
  /// Idle where the room is not convex with flat walls alone, where the mean chord 4 V / S has a depth above 1.5, and where
  /// there are more pairs than a fourth of the walks.
  ClearFlights(const Enclosure& enclosure, const PathSurfaces& surfaces, const EmbreeTracer& tracer,
               std::int64_t walks);

  bool idle() const { return weight_.empty(); }
  /// c of the pair; 0: not followed.
  double weight(std::int32_t wall, std::int32_t sphere) const {
    return weight_[static_cast<std::size_t>(wall - spheres_) * static_cast<std::size_t>(spheres_) +
                   static_cast<std::size_t>(sphere)];
  }
  /// A pair and c times its exchange area with the emissivities of both, m^2.
  struct Pair {
    std::int32_t wall, sphere;
    double area_m2;
  };
  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  std::int32_t spheres_;
  std::vector<float> weight_;  ///< [wall][sphere]
  std::vector<Pair> pairs_;
};

}  // namespace granrad
