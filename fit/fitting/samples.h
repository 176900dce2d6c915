#pragma once
#include <string>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"

namespace granrad {

/// View factors against distance, with the variance the finite number of rays gives each of them.
struct DistanceSamples {
  std::vector<double> distance;      ///< d*_pp = centre distance / d, or h/d of a wall
  std::vector<double> factor;        ///< F
  std::vector<double> variance;      ///< of F
  std::vector<double> unobstructed;  ///< exact F with nothing in between

  std::size_t size() const { return distance.size(); }
  void append(const DistanceSamples& more);
};

/// What one traced snapshot says about F and distance.
struct SampleSet {
  std::string origin;  ///< file it came from
  double solid_fraction = 0;
  Enclosure enclosure;
  DistanceSamples pairs;               ///< every pair within the cutoff, F = 0 included; each once
  std::vector<DistanceSamples> walls;  ///< by wall of the enclosure: every sphere
};

/// Samples from raw counts. Both directions of a pair are one estimate, weighted by rays per area:
///   X_ij = (hits_ij + hits_ji) / (n_i/A_i + n_j/A_j),  F = X / A_i.
/// The counts are taken before any closure, so the samples are unbiased. Throws InputError for what a
/// correlation cannot hold: radii that differ by more than 1 %, no enclosed volume, fewer than two spheres.
SampleSet make_samples(const Enclosure& enclosure, const HitCounts& counts, double pp_cutoff,
                       const std::string& origin);

}  // namespace granrad
