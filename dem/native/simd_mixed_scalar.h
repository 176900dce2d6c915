#pragma once
#include "dem/native/simd_scalar.h"

namespace granrad::native {

/// The law of a single contact in single precision: a pack for PairBodies with the operations of ScalarPack
/// that the law needs. Coefficients in memory are double, springs single.
struct ScalarMixed : LawInSingle {
  static constexpr int width = 1;
  using V = float;
  using M = bool;
  using Wide = ScalarPack;
  static constexpr int halves = 1;

  GRANRAD_INLINE V set(double x) { return static_cast<float>(x); }
  GRANRAD_INLINE V load(const double* p) { return static_cast<float>(*p); }
  GRANRAD_INLINE V load(const float* p) { return *p; }
  GRANRAD_INLINE void store(float* p, V a) { *p = a; }
  GRANRAD_INLINE V sqrt(V a) { return __builtin_sqrtf(a); }
  GRANRAD_INLINE V abs(V a) { return __builtin_fabsf(a); }
  GRANRAD_INLINE V max(V a, V b) { return a > b ? a : b; }
  GRANRAD_INLINE M less(V a, V b) { return a < b; }
  GRANRAD_INLINE V select(M m, V a, V b) { return m ? a : b; }
  GRANRAD_INLINE V keep(M m, V a) { return m ? a : 0.0f; }
  GRANRAD_INLINE bool any(M m) { return m; }

  GRANRAD_INLINE V narrow(const double a[1]) { return static_cast<float>(a[0]); }
  GRANRAD_INLINE void widen(V a, double out[1]) { out[0] = a; }
  /// To the nearest integer, ties to even, of |a| < 2^51: enough for forces of 24 bits.
  GRANRAD_INLINE std::int64_t to_fixed(double a) { return ScalarPack::to_fixed(a); }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities(const Rows* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    const float *a = row_at(rows, *i)->velocity, *b = row_at(rows, *j)->velocity;
    for (int k = 0; k < 3; ++k) u[k] = a[k] - b[k], w[k] = a[k + 4] + b[k + 4];
  }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities_apart(const Rows* rows, const Index* i, const Index* j, V u[3], V wi[3],
                                            V wj[3]) {
    const float *a = row_at(rows, *i)->velocity, *b = row_at(rows, *j)->velocity;
    for (int k = 0; k < 3; ++k) u[k] = a[k] - b[k], wi[k] = a[k + 4], wj[k] = b[k + 4];
  }
};

}  // namespace granrad::native
