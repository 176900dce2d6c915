#pragma once
#include "dem/native/simd_scalar.h"

namespace granrad {

/// Coefficients of one contact (paper Eqs. A.3-A.12). A contact with a wall has R* = R and m* = m.
template <class V>
struct HertzMindlin {
  V effective_radius;    ///< R*, m
  V normal;              ///< 4/3 Y*, so that k_n = normal sqrt(R* delta)
  V tangential;          ///< 8 G*, so that k_t = tangential sqrt(R* delta)
  V normal_damping;      ///< -2 sqrt(5/6) beta sqrt(2 m* Y*), so that gamma_n = it x (R* delta)^(1/4)
  V tangential_damping;  ///< -2 sqrt(5/6) beta sqrt(8 m* G*); beta = ln e / sqrt(ln^2 e + pi^2)
  V friction;            ///< mu
  V rolling;             ///< mu_r R*; used by `rolling_torque` only
};

/// Two bodies in contact, seen by the first. Overlap delta <= 0 means apart.
template <class S>
struct ContactState {
  typename S::V normal[3];        ///< unit vector e from the second body to the first
  typename S::V overlap;          ///< delta, m
  typename S::V velocity[3];      ///< v_i - v_j of the centres, m/s
  typename S::V arm_spin[3];      ///< a_i omega_i + a_j omega_j with arms a = r - delta/2, m/s
  typename S::V displacement[3];  ///< tangential spring s, m; updated
};

/// Force on the first body, N, and e x F_t, N. Torques are -a_i (e x F_t) on the first, -a_j (e x F_t) on the
/// second.
template <class S>
struct ContactForce {
  typename S::V force[3];
  typename S::V moment[3];
  typename S::V elastic;  ///< k_n delta, N
};

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
[[gnu::always_inline]] inline ContactForce<S> contact_force(const HertzMindlin<typename S::V>& law,
                                                            typename S::V step_s, ContactState<S>& c) {
  using V = typename S::V;
  const V zero = S::set(0.0);
  const auto touching = S::less(zero, c.overlap);
  const V delta = S::keep(touching, c.overlap);
  const V *e = c.normal, *u = c.velocity, *w = c.arm_spin;
  V* s = c.displacement;

  const V approach = u[0] * e[0] + u[1] * e[1] + u[2] * e[2];
  const V slip[3] = {u[0] - approach * e[0] - (e[2] * w[1] - e[1] * w[2]),
                     u[1] - approach * e[1] - (e[0] * w[2] - e[2] * w[0]),
                     u[2] - approach * e[2] - (e[1] * w[0] - e[0] * w[1])};
  const V root = S::sqrt(law.effective_radius * delta), fourth_root = S::sqrt(root);
  const V elastic = law.normal * root * delta;
  const V normal_force = elastic - law.normal_damping * fourth_root * approach;
  const V stiffness = law.tangential * root;

  for (int k = 0; k < 3; ++k) s[k] += slip[k] * step_s;
  const V off_plane = s[0] * e[0] + s[1] * e[1] + s[2] * e[2];
  for (int k = 0; k < 3; ++k) s[k] -= off_plane * e[k];

  const V limit = law.friction * S::abs(normal_force);
  const V spring_squared = stiffness * stiffness * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
  const auto sliding = S::less(limit * limit, spring_squared);
  V damping = law.tangential_damping * fourth_root;
  if (S::any(sliding)) {
    const V shorten = S::select(sliding, limit / S::sqrt(spring_squared), S::set(1.0));
    for (int k = 0; k < 3; ++k) s[k] = s[k] * shorten;
    damping = S::select(sliding, zero, damping);
  }
  ContactForce<S> out;
  V tangential[3];
  for (int k = 0; k < 3; ++k) {
    s[k] = S::keep(touching, s[k]);
    tangential[k] = S::keep(touching, -stiffness * s[k] - damping * slip[k]);
    out.force[k] = tangential[k] + S::keep(touching, normal_force * e[k]);
  }
  out.moment[0] = e[1] * tangential[2] - e[2] * tangential[1];
  out.moment[1] = e[2] * tangential[0] - e[0] * tangential[2];
  out.moment[2] = e[0] * tangential[1] - e[1] * tangential[0];
  out.elastic = elastic;
  return out;
}

/// Rolling friction of constant directional torque (LIGGGHTS `rolling_friction cdt`), on the first body, N m:
/// -mu_r k_n delta R* w/|w| without its part along e (torsion), w = omega_i - omega_j; the second body gets
/// the opposite.
template <class S>
[[gnu::always_inline]] inline void rolling_torque(const HertzMindlin<typename S::V>& law,
                                                  typename S::V elastic, const typename S::V e[3],
                                                  const typename S::V w[3], typename S::V torque[3]) {
  using V = typename S::V;
  const V square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
  const auto rolling = S::less(S::set(0.0), square);
  const V magnitude =
      S::keep(rolling, law.rolling * elastic / S::select(rolling, S::sqrt(square), S::set(1.0)));
  const V torsion = w[0] * e[0] + w[1] * e[1] + w[2] * e[2];
  for (int k = 0; k < 3; ++k) torque[k] = -magnitude * (w[k] - torsion * e[k]);
}

}  // namespace granrad
