#pragma once
#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/native/contact.h"

namespace granrad::native {

/// The law of Hertz and Mindlin with history and rolling friction (paper Eqs. A.3-A.12; Mindlin and
/// Deresiewicz 1953 for the tangential spring, Tsuji et al. 1992 for the damping).
struct HertzMindlin {
  enum class Coefficient {
    effective_radius,    ///< R*, m
    normal,              ///< 4/3 Y*, so that k_n = normal sqrt(R* delta)
    tangential,          ///< 8 G*, so that k_t = tangential sqrt(R* delta)
    normal_damping,      ///< -2 sqrt(5/6) beta sqrt(2 m* Y*), so that gamma_n = it x (R* delta)^(1/4)
    tangential_damping,  ///< -2 sqrt(5/6) beta sqrt(8 m* G*); beta = ln e / sqrt(ln^2 e + pi^2)
    friction,            ///< mu
    rolling,             ///< mu_r R*; used by `rolling_torque` only
    count
  };
  template <class V>
  using Values = Coefficients<HertzMindlin, V>;

  /// 1/Y* and 1/G* add the two compliances (paper Eqs. A.7, A.8). Restitution and the two friction
  /// coefficients of different materials are their geometric means (LAMMPS' mixing rule): a frictionless
  /// partner makes a frictionless contact.
  static Values<double> coefficients(const BodiesInContact& pair) {
    const auto compliance = [](const Material& m) {
      return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus_Pa;
    };
    const auto shear_compliance = [](const Material& m) {
      return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.youngs_modulus_Pa;
    };
    const Material &a = pair.a, &b = pair.b;
    const double young = 1 / (compliance(a) + compliance(b));
    const double shear = 1 / (shear_compliance(a) + shear_compliance(b));
    const double log_e = 0.5 * (std::log(a.restitution) + std::log(b.restitution));
    const double damping = -2 * std::sqrt(5.0 / 6.0) * log_e / std::sqrt(log_e * log_e + pi * pi);
    using enum Coefficient;
    Values<double> c;
    c[effective_radius] = pair.effective_radius_m;
    c[normal] = 4.0 / 3.0 * young;
    c[tangential] = 8 * shear;
    c[normal_damping] = damping * std::sqrt(2 * pair.effective_mass_kg * young);
    c[tangential_damping] = damping * std::sqrt(8 * pair.effective_mass_kg * shear);
    c[friction] = std::sqrt(a.friction * b.friction);
    c[rolling] = std::sqrt(a.rolling_friction * b.rolling_friction) * pair.effective_radius_m;
    return c;
  }

  /// Whether bodies of this material feel a rolling torque; the kernels for bodies that are all alike leave
  /// it out.
  static bool rolls(const Material& m) { return m.rolling_friction > 0; }

  /// Largest force of a contact of this overlap, m, and slip speed, m/s; N.
  static double force_bound(const Values<double>& c, double overlap, double speed) {
    using enum Coefficient;
    const double root = std::sqrt(c[effective_radius] * overlap);
    const double push = c[normal] * root * overlap + c[normal_damping] * std::sqrt(root) * speed;
    return push * (1 + c[friction]) + c[tangential_damping] * std::sqrt(root) * speed;
  }
  /// At least the torque of a contact over its force and the body's radius.
  static double moment_ratio(const Material& m) { return std::max({1.0, m.friction, m.rolling_friction}); }

  /// Hertz-Mindlin with history, exactly as LIGGGHTS' `gran model hertz tangential history` computes it:
  ///
  ///   F_n = k_n delta - gamma_n v_n (the attractive tail at the end of a contact is kept),
  ///   s <- P(s + v_t dt), P the projection on today's tangent plane, v_t the slip velocity of the surfaces,
  ///   F_t = -k_t s - gamma_t v_t with today's k_t; when k_t |s| > mu |F_n| the contact slides: s is rescaled
  ///   to mu |F_n| / k_t and the tangential damping is dropped.
  ///
  /// Bodies apart give zero force and forget s. Swapping the bodies negates every result exactly.
  /// S: the pack of lanes (dem/native/simd_*.h); ScalarPack for one contact.
  template <class S>
  GRANRAD_INLINE ContactForce<S> force(const Values<typename S::V>& law, typename S::V step_s,
                                       ContactState<S>& c) {
    using V = typename S::V;
    using enum Coefficient;
    const V zero = S::set(0.0);
    const auto touching = S::less(zero, c.overlap);
    const V delta = S::keep(touching, c.overlap);
    const V *e = c.normal, *u = c.velocity, *w = c.arm_spin;
    V* s = c.displacement;

    const V approach = u[0] * e[0] + u[1] * e[1] + u[2] * e[2];
    const V slip[3] = {u[0] - approach * e[0] - (e[2] * w[1] - e[1] * w[2]),
                       u[1] - approach * e[1] - (e[0] * w[2] - e[2] * w[0]),
                       u[2] - approach * e[2] - (e[1] * w[0] - e[0] * w[1])};
    const V root = S::sqrt(law[effective_radius] * delta), fourth_root = S::sqrt(root);
    const V elastic = law[normal] * root * delta;
    const V normal_force = elastic - law[normal_damping] * fourth_root * approach;
    const V stiffness = law[tangential] * root;

    for (int k = 0; k < 3; ++k) s[k] += slip[k] * step_s;
    const V off_plane = s[0] * e[0] + s[1] * e[1] + s[2] * e[2];
    for (int k = 0; k < 3; ++k) s[k] -= off_plane * e[k];

    const V limit = law[friction] * S::abs(normal_force);
    const V spring_squared = stiffness * stiffness * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    const auto sliding = S::less(limit * limit, spring_squared);
    V damping = law[tangential_damping] * fourth_root;
    if (S::any(sliding)) {
      const V shorten = S::select(sliding, limit / S::sqrt(spring_squared), S::set(1.0));
      for (int k = 0; k < 3; ++k) s[k] = s[k] * shorten;
      damping = S::select(sliding, zero, damping);
    }
    ContactForce<S> out;
    V push[3];
    for (int k = 0; k < 3; ++k) {
      s[k] = S::keep(touching, s[k]);
      push[k] = S::keep(touching, -stiffness * s[k] - damping * slip[k]);
      out.force[k] = push[k] + S::keep(touching, normal_force * e[k]);
    }
    out.moment[0] = e[1] * push[2] - e[2] * push[1];
    out.moment[1] = e[2] * push[0] - e[0] * push[2];
    out.moment[2] = e[0] * push[1] - e[1] * push[0];
    out.elastic = elastic;
    return out;
  }

  /// Rolling friction of constant directional torque (LIGGGHTS `rolling_friction cdt`), on the first body, N m:
  /// -mu_r k_n delta R* w/|w| without its part along e (torsion), w = omega_i - omega_j; the second body gets
  /// the opposite.
  template <class S>
  GRANRAD_INLINE void rolling_torque(const Values<typename S::V>& law, typename S::V elastic,
                                     const typename S::V e[3], const typename S::V w[3],
                                     typename S::V torque[3]) {
    using V = typename S::V;
    const V square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    const auto rolling = S::less(S::set(0.0), square);
    const V magnitude = S::keep(
        rolling, law[Coefficient::rolling] * elastic / S::select(rolling, S::sqrt(square), S::set(1.0)));
    const V torsion = w[0] * e[0] + w[1] * e[1] + w[2] * e[2];
    for (int k = 0; k < 3; ++k) torque[k] = -magnitude * (w[k] - torsion * e[k]);
  }
};

}  // namespace granrad::native
