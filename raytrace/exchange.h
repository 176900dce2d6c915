#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// Sparse square matrix in compressed rows, columns ascending in each row.
struct SparsePattern {
  std::vector<std::int64_t> row_begin;  ///< [surfaces + 1]
  std::vector<std::int32_t> column;     ///< [nnz]
};

/// Raw result of ray tracing: integer, exact under any order of addition. hits[k] of launched[i] rays of
/// surface i ended on surface column[k]. Kept on file so that a refit never retraces.
struct HitCounts {
  SparsePattern pattern;
  std::vector<std::int64_t> hits;      ///< [nnz]
  std::vector<std::int64_t> launched;  ///< [surfaces]
  std::vector<double> area_m2;         ///< [surfaces]
  std::int32_t spheres = 0;            ///< surfaces before the walls
  /// Variance of a count relative to binomial, found from independent replicates of low-discrepancy rays, by
  /// the kind of pair (pair_kind) and the size of the count: [b] for counts in [2^b, 2^(b+1)), the last one
  /// also beyond. Empty: binomial.
  std::array<std::vector<double>, 4> variance_factor;
  /// The same of each pair of walls, from its own replicates: [a (walls + 1) + b], b = walls the surroundings. How even a
  /// low-discrepancy set is depends on what the pair sees of each other, three times in variance. Empty: by size.
  std::vector<double> wall_variance_factor{};
  /// The same of a particle's sum over the walls whose error is stated (see StatedQuantity).
  double sum_variance_factor = 1;
  std::int64_t leaked = 0;        ///< rays that met the back of a wall or were lost
  double mean_chord_m = 0;        ///< area-weighted mean free length of a ray over all surfaces
  double mean_chord_error_m = 0;  ///< its standard error (binomial sampling)
  std::int64_t directions = 0;    ///< of all replicates of parallel lines; 0: rays, each of its own direction
  /// Hits by replicate, where a trace was asked to keep them (TraceOptions::kept_replicates).
  struct Part {
    std::int32_t from, to, hits;
  };
  std::vector<std::vector<Part>> parts{};  ///< [replicates]
  /// > 1: to respect the memory limit, a pair with h < unit hits was kept with probability h / unit, as
  /// `unit` hits: unbiased, the same draw for both directions of a pair. 1: nothing was thinned.
  std::int64_t thinning_unit = 1;
};

/// Exchange areas X_ij = A_i F_ij, m^2, with the variance of each.
struct ExchangeAreas {
  SparsePattern pattern;
  std::vector<double> value;     ///< [nnz] X_ij
  std::vector<double> variance;  ///< [nnz] of X_ij; empty when not estimated (correlation tables)
  std::vector<double> area_m2;   ///< [surfaces]; emissivity * area for total exchange areas
  /// [surfaces] n_i / A_i, 1/m^2: what the two one-way estimates of a pair are weighted by when they are
  /// merged. Empty: both have the same weight and the same error (symmetric estimates, correlation tables).
  std::vector<double> rays_per_m2{};
};

/// A share of an exchange area X_ij as one replicate found it: sums over all samples of a replicate are an independent
/// estimate of sums over all pairs. One-way estimates come with the weight they are merged by.
struct ReplicateSample {
  std::int32_t i, j;
  float x_m2;
};
using ReplicateSamples = std::vector<std::vector<ReplicateSample>>;  ///< [replicates]; empty: not kept

/// 0: particle to particle, 1: particle to wall or surroundings, 2: wall to particle, 3: between walls.
inline std::size_t pair_kind(std::int32_t spheres, std::int32_t from, std::int32_t to) {
  return (from >= spheres ? 2u : 0u) + (to >= spheres ? 1u : 0u);
}

/// Variance of counts.hits[k], of surface i, relative to binomial.
double count_variance_factor(const HitCounts& counts, std::size_t i, std::int64_t k);

/// What closing an estimate changed. Defects are relative to the row sum A_i.
struct ClosureReport {
  double closure_defect = 0;      ///< max |sum_j X_ij / A_i - 1| before
  double reciprocity_defect = 0;  ///< sqrt( sum (X_ij - X_ji)^2 / sum X_ij^2 ) before
  double reciprocity_chi2 = 0;    ///< reduced chi^2 of X_ij - X_ji against its variance; 0 without variances
  double largest_correction = 0;  ///< max |row scaling - 1|
  double reciprocity_rms =
      0;  ///< of (X_ij - X_ji) / sqrt(A_i A_j) over the pairs left, after: 0 but for row sums
  int sweeps = 0;
};

enum class Closure { reciprocal, row_sum };

/// X_ij = A_i hits_ij / launched_i with variance A_i^2 p (1 - p) / n times the count's factor, p = h / n:
/// right on the mean over pairs, hit or not, so that sums of variances are right; 1 - p is at least 1 / 2(n +
/// 1), so that n hits of n claim no certainty. One-way estimates: not symmetric, rows of surfaces without
/// rays empty.
ExchangeAreas one_way_estimate(const HitCounts& counts);

/// What the replicates kept in `counts` say of the merged exchange areas, before closure.
ReplicateSamples replicate_samples(const HitCounts& counts);

/// Closes rows.
/// reciprocal: merges X_ij and X_ji by inverse variance (weights n_i / A_i: both counts see the same X), then
/// scales x_i X_ij x_j (symmetric Sinkhorn, x_i <- x_i sqrt(A_i / r_i)) until every row sums to A_i within
/// 1e-12. Result exactly symmetric. row_sum: the paper's Eq. (norm), row by row; closes, breaks reciprocity;
/// kept for replication. The last surface, the surroundings, is a black surface of whatever area its row
/// comes to: it is not scaled, and area_m2.back() of the result is that row sum. Surfaces of area 0 (dropped,
/// or reflecting everything) stay empty. Variances are carried through to first order: what of a pair's error
/// closure takes out through the sums of its two rows, and what the other pairs' errors put in. Throws
/// NumericalError when scaling cannot converge (a surface sees nothing, or only surfaces that cannot fill
/// it).
ExchangeAreas close(const ExchangeAreas& estimate, Closure closure, ClosureReport& report);

/// Root mean square of (X_ij - X_ji) / sqrt(A_i A_j), which is F_ij - F_ji where areas are equal, over the pairs among
/// the first `surfaces` that exchange anything: 0 once closed reciprocally.
double reciprocity_rms(const ExchangeAreas& x, std::size_t surfaces);

/// Rows and columns of the surfaces in `kept` (ascending), renumbered: what the others (excluded walls) exchanged
/// is lost from the rows. To be called before closure.
ExchangeAreas restricted(const ExchangeAreas& all, const std::vector<std::int32_t>& kept);

/// 99 % upper bound of F_ij of a surface that no ray of its own hit j with: b_i = m / n_i, at most 1, where m
/// = -ln 0.01 (Poisson), and 2 thinning_unit more where rare pairs were thinned out. 1 for surfaces without
/// rays. Lines of one direction meet a neighbour together: the discs of a pair lie over each other by a quarter on the
/// mean, so that a quarter of the lines through a disc count as one.
std::vector<double> zero_hit_bound(const HitCounts& counts);

/// Reduced chi^2 of X_ij - X_ji over the pairs both of whose ends sent rays; 0 when there are none.
double reciprocity_chi2(const ExchangeAreas& one_way);

/// The pattern with every (i, j) present together with (j, i).
SparsePattern symmetrized(const SparsePattern& pattern);

}  // namespace granrad
