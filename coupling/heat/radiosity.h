#pragma once
#include <vector>

#include "raytrace/exchange.h"

namespace granrad {

/// Grey diffuse surfaces with one radiosity each.
struct RadiosityResult {
  std::vector<double> radiosity_W_m2;    ///< J; the emissive power for black surfaces
  std::vector<double> heat_W;            ///< received net
  std::vector<double> standard_error_W;  ///< from the variances of X; empty without them
  int iterations = 0;                    ///< 0: every surface black, nothing solved
  double relative_residual = 0;
};

/// Net heats Q_i = sum_j X_ij (J_j - J_i) with J = eps E + (1 - eps) F J (paper Eq. radiosity, in the form
/// that divides by nothing: eps = 0 re-radiates, eps = 1 needs no solve).
///
/// Symmetric X: (I - r G r) y = r A^-1/2 X eps E, r = sqrt(1 - eps), G = A^-1/2 X A^-1/2, J = eps E + r
/// A^-1/2 y, by conjugate gradients; opposite terms go to both ends, so heats sum to 0 within round-off.
/// Otherwise (row_sum closure) (I - (1 - eps) F) J = eps E by BiCGSTAB. The same bits for any number of
/// threads. Standard errors to first order: var Q_i = sum_j var X_ij (J_j - J_i)^2.
///
/// Precondition: rows close (sum_j X_ij = A_i); the emissive powers are taken relative to the smallest, so
/// that an isothermal enclosure gives exactly 0. Shapes: all vectors [surfaces]; W/m^2; emissivity in [0, 1].
/// A surface with an empty row gets no heat. Where re-radiating surfaces see nothing but each other, they get
/// none. Throws NumericalError when the solver stalls.
RadiosityResult solve_radiosity(const ExchangeAreas& areas, const std::vector<double>& emissive_power_W_m2,
                                const std::vector<double>& emissivity);

}  // namespace granrad
