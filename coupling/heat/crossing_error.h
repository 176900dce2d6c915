#pragma once
#include <vector>

#include "raytrace/exchange.h"

namespace granrad {

/// Standard error of the heat that some surfaces give, by how far replicates of the rays differ in it: the only honest
/// error where the counts of a row depend on each other and low-discrepancy points make sums far better than pairs.
///
/// To first order dQ = sum over pairs of (J_i - J_j)(a_i - a_j) dX_ij, J the radiosities, a those of emissive power 1 on
/// the surfaces that give and 0 elsewhere (the adjoint). Closure takes out of dX_ij what changes row sums: with
/// t_i = sum_j X_ij (J_i - J_j)(a_i - a_j) and (diag(A) + X) c = t over the rows that close,
///   dQ = sum over pairs of ((J_i - J_j)(a_i - a_j) - c_i - c_j) dX_ij,
/// worked out for every replicate. `areas` closed; vectors by row of it; at least two replicates.
double crossing_error_W(const ExchangeAreas& areas, const ReplicateSamples& replicates,
                        const std::vector<double>& radiosity_W_m2, const std::vector<double>& adjoint);

}  // namespace granrad
