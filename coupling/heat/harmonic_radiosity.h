#pragma once
#include <vector>

#include "raytrace/lines/exchange_moments.h"

namespace granrad {

/// Net heats of grey surfaces whose radiosity varies over them (see ExchangeMoments): the Galerkin form of the
/// integral equation of grey diffuse enclosures (Modest, Radiative Heat Transfer, ch. 5),
/// B = eps E + (1 - eps) H,
///     M_i b_i / rho_i - sum_j K_ij b_j = eps_i / rho_i E_i m_i,   rho = 1 - eps, m_i = M_i (1, 0, ...),
/// symmetric positive definite, by conjugate gradients with the blocks M_i / rho_i as preconditioner; black
/// surfaces (rho = 0) radiate E and are not solved for. An isothermal enclosure is an exact solution.
/// emissive_power and emissivity by surface number (emissivity 0: re-radiating). Returns the heat received by
/// each surface, W. Throws NumericalError when the solver stalls.
std::vector<double> solve_harmonic_radiosity(const ExchangeMoments& moments,
                                             const std::vector<double>& emissive_power_W_m2,
                                             const std::vector<double>& emissivity);

}  // namespace granrad
