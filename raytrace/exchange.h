#pragma once
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
  std::vector<double> variance_factor; ///< empty, or [surfaces]: variance of F relative to binomial (QMC replicates)
  std::int64_t leaked = 0;             ///< rays that met the back of a wall or were lost
  double mean_chord_m = 0;             ///< area-weighted mean free length of a ray over all surfaces
};

/// Exchange areas X_ij = A_i F_ij, m^2, with the variance of each.
struct ExchangeAreas {
  SparsePattern pattern;
  std::vector<double> value;     ///< [nnz] X_ij
  std::vector<double> variance;  ///< [nnz] of X_ij; empty when not estimated (correlation tables)
  std::vector<double> area_m2;   ///< [surfaces]; emissivity * area for total exchange areas
};

/// What closing an estimate changed. Defects are relative to the row sum A_i.
struct ClosureReport {
  double closure_defect = 0;      ///< max |sum_j X_ij / A_i - 1| before
  double reciprocity_defect = 0;  ///< sqrt( sum (X_ij - X_ji)^2 / sum X_ij^2 ) before
  double reciprocity_chi2 = 0;    ///< reduced chi^2 of X_ij - X_ji against its variance; 0 without variances
  double largest_correction = 0;  ///< max |row scaling - 1|
  int sweeps = 0;
};

enum class Closure { reciprocal, row_sum };

/// X_ij = A_i hits_ij / launched_i with its binomial variance (Wilson-regularised, so that one hit does not
/// claim certainty). One-way estimates: not symmetric, rows of surfaces without rays empty.
ExchangeAreas one_way_estimate(const HitCounts& counts);

/// Closes rows.
/// reciprocal: merges X_ij and X_ji by inverse variance, then scales x_i X_ij x_j (symmetric Sinkhorn,
/// x_i <- x_i sqrt(A_i / r_i)) until every row sums to A_i within 1e-12. Result exactly symmetric.
/// row_sum: the paper's Eq. (norm), row by row; closes, breaks reciprocity; kept for replication.
/// Variances are propagated. Throws NumericalError when scaling cannot converge (a surface sees nothing).
ExchangeAreas close(const ExchangeAreas& estimate, Closure closure, ClosureReport& report);

/// The pattern with every (i, j) present together with (j, i).
SparsePattern symmetrized(const SparsePattern& pattern);

}  // namespace granrad
