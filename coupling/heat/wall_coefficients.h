#pragma once
#include <optional>
#include <vector>

#include "coupling/heat/heat_step.h"
#include "dem/bed/bed.h"

namespace granrad {

/// Channel-averaged wall-to-particle coefficients (paper Eq. hcoeff), W/(m^2 K). The Nusselt number is
/// h_wp d_p / k_gas (Eq. Nud).
struct WallCoefficients {
  HeatPaths h_W_m2K;    ///< per path; their sum is h_wp
  double per_watt = 0;  ///< of heat: 1 / ((T_w - T_mean) A_w)
};

/// h = Q / ((T_w - T_mean) A_w), A_w the area of all isothermal walls inside the heat-transfer region (paper: 2 A_w for
/// its two), T_w their temperature, T_mean the number average of the particles. Nothing when the region has no
/// isothermal wall, when those it has differ in temperature by more than 1e-6 of it (there is no one driving
/// difference), or when T_w and T_mean differ by less than 1e-6 K.
std::optional<WallCoefficients> wall_coefficients(const Bed& bed, const Box& region, const HeatPaths& heat_W,
                                                  double mean_temperature_K);

/// The isothermal walls that have an area in the region: their numbers in the Bed.
std::vector<std::size_t> hot_walls(const Bed& bed, const Box& region);
/// Whether these walls are at one temperature.
bool at_one_temperature(const Bed& bed, const std::vector<std::size_t>& walls);

/// Pe_L = v L / alpha, alpha = k_s / (rho c) (paper Eq. Ped).
double peclet_length(double velocity_m_s, double length_m, const Material& material);

/// Pe_d* = Pe_L (k_s / k_gas)^2 (d_p / L)^2 (paper Eq. Ped).
double peclet_modified(double peclet_length, double length_m, double diameter_m, const Material& material,
                       double gas_conductivity_W_mK);

}  // namespace granrad
