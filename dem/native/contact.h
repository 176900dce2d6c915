#pragma once
#include "dem/bed/material.h"
#include "dem/native/simd_scalar.h"

// What a contact law is given and what it returns. A law is one header with a struct of
//   enum class Coefficient { ..., count }     the numbers of a contact that do not change while it lasts,
//   static coefficients(BodiesInContact)      how two materials make them,
//   static force<S>, rolling_torque<S>        what it does with them,
//   static rolls, force_bound, moment_ratio   what the kernels and the fixed-point scales must know of it.
// Columns, packs, kernels and walls run over the enum; none of them names a coefficient. The engine's law is
// chosen in contact_law.h.
namespace granrad::native {

/// One value of each coefficient of a law, for one contact (V double) or a pack of them.
template <class Law, class V>
class Coefficients {
 public:
  using Name = typename Law::Coefficient;
  static constexpr int count = static_cast<int>(Name::count);
  [[gnu::always_inline]] V& operator[](Name c) { return value_[static_cast<int>(c)]; }
  [[gnu::always_inline]] const V& operator[](Name c) const { return value_[static_cast<int>(c)]; }
  /// Makes each from its place in the list and nothing else: value(n) is the n-th.
  template <class Value>
  [[gnu::always_inline]] static inline Coefficients each(Value value) {
    Coefficients all;
    for (int n = 0; n < count; ++n) all.value_[n] = value(n);
    return all;
  }
  [[gnu::always_inline]] const V& at(int n) const { return value_[n]; }

 private:
  V value_[count]{};
};

/// A body as its contacts see it.
struct ContactBody {
  const Material* material;
  double radius_m;
  double mass_kg;
};

/// Two bodies as a law mixes them. A wall is made of the particle's own material, with R* = R and m* = m (as
/// LIGGGHTS does).
struct BodiesInContact {
  const Material& a;
  const Material& b;
  double effective_radius_m;  ///< R*, 1/R* = 1/R_a + 1/R_b (paper Eq. A.10)
  double effective_mass_kg;   ///< m*, 1/m* = 1/m_a + 1/m_b (paper Eq. A.9)

  static BodiesInContact particles(const ContactBody& a, const ContactBody& b) {
    return {*a.material, *b.material, a.radius_m * b.radius_m / (a.radius_m + b.radius_m),
            a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg)};
  }
  static BodiesInContact with_wall(const ContactBody& body) {
    return {*body.material, *body.material, body.radius_m, body.mass_kg};
  }
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

}  // namespace granrad::native
