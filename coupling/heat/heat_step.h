#pragma once
#include <vector>

#include "coupling/heat/conduction.h"
#include "dem/bed/bed.h"

namespace granrad {

/// One number per path of heat: solid contacts, gas lenses, radiation. A further path is a member and a line of `paths`.
struct HeatPaths {
  double solid = 0, gas = 0, radiation = 0;

  struct Path {
    const char* column;  ///< its name in frames
    double HeatPaths::*value;
  };
  static const std::vector<Path>& paths();
  double total() const;
};

/// m c of a particle, J/K.
double heat_capacity_J_K(const Bed& bed, std::size_t i);

/// A conduction step may move a particle at most this part of the way to its neighbours: dt sum(G)/(m c).
inline constexpr double conduction_step_fraction = 0.1;

/// Temperatures follow the energy balance of a particle, m c dT/dt = Q_cond + Q_rad (the paper's Eq. (Ebalance)).
/// Largest conduction step, s: 0.1 min_i m_i c_i / sum_j G_ij; infinite when nothing conducts.
double conduction_step_limit_s(const Bed& bed, const Conductances& conductances);

/// Shortest radiative time constant, s: m c / (4 eps sigma T^3 A) with T the hottest particle or radiating
/// wall (isothermal or open), or `hottest_K` where that is more. Heat held over an interval dt is monotone for dt below
/// it, stable below twice that. Infinite without particles.
double radiation_time_constant_s(const Bed& bed, double hottest_K = 0);

/// Radiation intervals up to this part of radiation_time_constant_s hold the heats of the temperatures midway; longer
/// ones use the emission of their end (RadiativeState::implicit).
inline constexpr double explicit_radiation_fraction = 0.1;

/// What each particle's temperature makes of its radiation within an interval: k = eps A s dt / (m c), with s the slope
/// of the chord of sigma T^4 from its temperature `from_K` to the hottest, s = sigma (T_h^2 + T^2)(T_h + T). sigma T^4 lies
/// below that chord: T + Q dt / (m c) with the heat Q of emission linearised by it stays between the coldest and the
/// hottest temperature for any dt, and tends to the right equilibrium; first order in dt.
std::vector<double> radiative_relaxation(const Bed& bed, const std::vector<double>& from_K, double hottest_K,
                                         double interval_s);

/// Adds what contacts and gas give each particle, W, with the particles at T.
void add_conduction_W(const Bed& bed, const Conductances& conductances, const std::vector<double>& T,
                      std::vector<double>& heat_W);

/// Advances bed.temperature_K by one explicit Euler step: m c dT = dt (sum_j G_ij (T_j - T_i) + Q_i), Q_i the
/// held bed.radiative_heat_W. The heat of a pair is one number given to both ends with opposite signs, so
/// energy is conserved to round-off. Returns the heat the particles received in this step, J: from isothermal
/// walls by contact and gas, and by radiation. Throws NumericalError when dt exceeds conduction_step_limit_s
/// (naming it), or when a temperature leaves (0, infinity).
HeatPaths advance_temperatures(Bed& bed, const Conductances& conductances, double dt_s);

/// The same with the heats of other temperatures `from_K`: those of the middle of the step make it of second order.
HeatPaths advance_temperatures(Bed& bed, const Conductances& conductances, double dt_s,
                               const std::vector<double>& from_K);

/// Temperatures half a step ahead by Euler, K (explicit midpoint rule; Hairer, Norsett, Wanner, Solving ordinary differential
/// equations I, II.1). Up to conduction_step_fraction the step then taken, I - A + A^2 / 2 with A = dt G / (m c), has no
/// negative entry and rows that sum to one: no temperature leaves the range of those around.
std::vector<double> mid_step_temperatures_K(const Bed& bed, const Conductances& conductances, double dt_s);

/// Temperatures in the middle of the coming radiation interval, K, extrapolated with the heats held until now from where
/// conduction alone leads by then: T_i + Q_i dt / (2 m c). A source asked for heats at these makes holding them second
/// order in dt instead of first (error of a lone sphere after 2 s at dt = 0.01 s: 2e-7 instead of 1.1e-4), and it conserves
/// energy as before, since it gives the heats of one set of temperatures. For dt up to explicit_radiation_fraction of
/// radiation_time_constant_s.
std::vector<double> midway_temperatures_K(const Bed& bed, std::vector<double> conducted_K, double interval_s);

/// sum m c T, J, compensated.
double thermal_energy_J(const Bed& bed);

/// Number average of the temperatures of the particles with in_region[i] != 0 (empty: all), K; 0 without any.
double mean_temperature_K(const Bed& bed, const std::vector<char>& in_region = {});

}  // namespace granrad
