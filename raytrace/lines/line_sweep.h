#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/rays/ray_monitor.h"

namespace granrad {

class WallPatches;

/// Global parallel lines: the fast exchange source for spheres of any radii in a convex box or polyhedron.
///
/// Diffuse emission from convex bodies into a convex void is a uniform, isotropic field of lines (Santalo, Integral
/// Geometry, 1976; global lines: Sbert, Comput. Graph. Forum 12 (1993) C-409), and two
/// surfaces exchange along every line on which they are neighbours:
///     X_ij = A_i F_ij = (2 h^2 / D) S_ij,
/// S_ij the lines on which i and j follow each other (in either order), h the spacing of a square lattice of
/// parallel lines, D directions spread over the hemisphere. Reciprocity and energy balance hold line by line.
/// Spheres are taken in the order of their centres along the direction, which is the order of their chords'
/// midpoints: for disjoint spheres, and for overlapping ones wherever one chord does not lie inside the
/// other, the order of entry, so that a line which leaves i inside j is an exchange at distance zero. Where a
/// chord lies inside another, a pair gets the mean of the two one-way values of that rule; the share of such
/// line ends is (delta / 4r)^2 per contact of overlap delta (1.6e-4 at delta = 0.05 r).
/// Periodic directions (the others closed by walls): line ends are counted in the box itself and look back at
/// images upstream, as far as five mean chords; the few that meet nothing there are traced one by one through
/// the periods. A sphere may see its own image (X_ii > 0). S stays symmetric and rows close.
/// A sphere that pokes through a wall exchanges with it at distance zero; what of it no line inside the
/// walls can meet is left out.
struct LineOptions {
  int directions = 500;  ///< per replicate
  /// Mean number of lines through a small sphere (the 10 % quantile of the radii); larger spheres get more in
  /// proportion to area. Work grows with the sum.
  double lines_per_disc = 12;
  int replicates = 4;  ///< independent randomisations, >= 2: the only honest error of low-discrepancy sets
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: OpenMP's default; results do not depend on it
  /// > 0: `directions` grows until the stated error (stated_error.h) of counts or areas, or that of the
  /// particle heats, rms relative to the rms heat, falls below it.
  double target_error = 0;
  /// Surface numbers; empty: the error of particle-wall sums is stated.
  std::vector<std::int32_t> hot_walls{};
  TraceWatch watch{};  ///< of counts and areas: progress of the present round, and whether to go on
  std::size_t memory_limit_bytes = std::size_t{4} << 30;  ///< of the counts; see LineReport::thinning_unit
};

/// What a sweep spent and found out about itself.
struct LineReport {
  /// Line ends on surfaces, of all rounds: each is one ray of a ray tracer.
  std::int64_t ray_equivalents = 0;
  int directions = 0;          ///< per replicate, after target_error
  double spacing_m = 0;        ///< of the lines, h
  double estimated_error = 0;  ///< the quantity target_error bounds
  /// > 1: to respect the memory limit, pairs with fewer counts n were kept with probability n / unit and weight
  /// unit (unbiased; symmetric; rows rescaled by closure). 1: nothing was thinned.
  int thinning_unit = 1;
  int rounds = 0;  ///< of target_error; the last one is what is kept
};

/// Counts of line ends: hits symmetric, launched[i] = row sums; the row of the surroundings is empty.
/// variance_factor holds the variance of a merged pair relative to binomial, from the replicates, doubled:
/// both counts of a pair are the same lines, so that merging them must not gain anything.
/// Throws InputError: meshes, periodic boxes whose other directions are open, walls that are not convex, a
/// sphere centre outside the walls, values that are not finite.
HitCounts sweep_view_factors(const Enclosure& enclosure, const LineOptions& options,
                             LineReport* report = nullptr);

/// The same as exchange areas with their variance: exactly symmetric; rows sum to the sampled area, which
/// differs from area_m2 by noise until closed.
/// `replicates`: what each replicate found; left empty when there are too many pairs to keep them. `patches`: of the walls;
/// surfaces are then those of patches->applied_to(enclosure).
ExchangeAreas sweep_exchange_areas(const Enclosure& enclosure, const LineOptions& options,
                                   LineReport* report = nullptr, ReplicateSamples* replicates = nullptr,
                                   const WallPatches* patches = nullptr);

/// Net heat received by every black surface, W, without a matrix: sum_j X_ij (E_j - E_i) for the emissive
/// powers E [surface_count], W/m^2. Sums in integers: the heats add up to zero within round-off of the
/// result, equal E give exactly zero, and the bits do not depend on threads or instruction set. `replicate_heat_W`
/// takes the heats of each replicate, whose mean is the result: for errors of sums.
std::vector<double> sweep_black_heat(const Enclosure& enclosure,
                                     const std::vector<double>& emissive_power_W_m2,
                                     const LineOptions& options,
                                     std::vector<double>* standard_error_W = nullptr,
                                     LineReport* report = nullptr,
                                     std::vector<std::vector<double>>* replicate_heat_W = nullptr);

}  // namespace granrad
