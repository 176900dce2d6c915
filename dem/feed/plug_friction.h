#pragma once

namespace granrad {

/// How wall friction slows a plug whose spheres start with a transverse granular temperature T0.
///
/// The temperature decays by Haff's law, T = T0 / (1 + t/tau)^2, tau = 6 / ((1 - e^2) w), collision frequency
/// w = 24 phi g sqrt(T0/pi) / d, g = (1 - phi/2) / (1 - phi)^3; its pressure rho phi T (1 + 2 (1 + e) phi g)
/// presses the spheres on the walls, which pull back with mu times that over the perimeter U of the section
/// A:
///   dv/dt = mu U/A (1 + 2 (1 + e) phi g) T,   v lost at age t = a tau t / (tau + t),   a = dv/dt at t = 0.
/// (Kinetic theory of smooth inelastic spheres; T0 = 2/3 std^2, two of three directions being set.) Against
/// the native engine, mean loss in the channel, alumina at 1.59 g/s: phi .07/.25/.43/.48 predicted
/// 0.03/0.4/1.0/1.25 %, measured 0.04/0.45/0.95/1.3 %.
struct PlugFriction {
  double deceleration_m_s2 = 0;  ///< a
  double cooling_time_s = 1;     ///< tau

  /// Speed lost by a sphere that entered `age_s` ago, m/s.
  double loss_m_s(double age_s) const;
  /// Its mean over the ages 0 .. residence_s.
  double mean_loss_m_s(double residence_s) const;
};

struct PlugFrictionInput {
  double solid_fraction, transverse_velocity_std_m_s, diameter_m, restitution, friction;
  double perimeter_over_area_1_m;  ///< of the walled sides of the section
};

PlugFriction plug_friction(const PlugFrictionInput& in);

}  // namespace granrad
