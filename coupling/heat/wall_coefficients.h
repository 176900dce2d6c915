#pragma once
#include <optional>

#include "coupling/heat/heat_step.h"
#include "dem/bed/bed.h"

namespace granrad {

/// Channel-averaged wall-to-particle coefficients (paper Eq. hcoeff, Nud), W/(m^2 K).
struct WallCoefficients {
  HeatPaths h_W_m2K;      ///< per path
  double h_wp_W_m2K = 0;  ///< their sum
  double Nu_d = 0;        ///< h_wp d_p / k_gas; 0 without gas
};

/// h = Q / ((T_w - T_mean) A_w), A_w the area of all isothermal walls (paper: 2 A_w for its two), T_w their
/// area-weighted temperature, T_mean the number average of the particles. Nothing when there is no isothermal
/// wall, or when T_w and T_mean differ by less than 1e-6 K.
std::optional<WallCoefficients> wall_coefficients(const Bed& bed, const HeatPaths& heat_W,
                                                  double mean_temperature_K, double diameter_m,
                                                  double gas_conductivity_W_mK);

/// Pe_L = v L / alpha, alpha = k_s / (rho c) (paper Eq. Ped).
double peclet_length(double velocity_m_s, double length_m, const Material& material);

/// Pe_d* = Pe_L (k_s / k_gas)^2 (d_p / L)^2 (paper Eq. Ped).
double peclet_modified(double peclet_length, double length_m, double diameter_m, const Material& material,
                       double gas_conductivity_W_mK);

}  // namespace granrad
