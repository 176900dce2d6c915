#pragma once
#include <cstddef>
#include <vector>

#include "raytrace/exchange.h"

namespace granrad {

/// Whether closure scales a row: not that of the surroundings, nor rows without area.
inline bool closes(const ExchangeAreas& x, std::size_t i) {
  return i + 1 < x.area_m2.size() && x.area_m2[i] > 0;
}

/// The factors f_i that make every row of f_i X_ij f_j sum to its area within 1e-12 (X symmetric; f = 1 for rows that do
/// not close). Symmetric Sinkhorn sweeps f_i <- f_i sqrt(A_i / r_i), which stall where groups of surfaces see nearly only
/// each other (two wide plates close together); there Newton's method on the convex function
///   1/2 sum X_ij f_i f_j - sum A_i ln f_i
/// of the logarithms, its equations solved by conjugate gradients. Bits do not depend on threads.
/// `sweeps`: of both. Throws NumericalError when there are none.
std::vector<double> balancing_factors(const ExchangeAreas& x, int& sweeps);

}  // namespace granrad
