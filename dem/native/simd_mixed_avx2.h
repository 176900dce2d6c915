#pragma once
#include "dem/native/simd_avx2.h"

namespace granrad::native {

/// The law of eight contacts at once in single precision. Operations as in ScalarMixed, same rounding.
struct Avx2Mixed : LawInSingle {
  static constexpr int width = 8;
  typedef float V __attribute__((vector_size(32)));
  using M = __m256;
  using Wide = Avx2Pack;
  static constexpr int halves = 2;

  GRANRAD_INLINE V set(double x) { return _mm256_set1_ps(static_cast<float>(x)); }
  GRANRAD_INLINE V join(__m128 low, __m128 high) { return _mm256_set_m128(high, low); }
  GRANRAD_INLINE V load(const double* p) {
    return join(_mm256_cvtpd_ps(_mm256_loadu_pd(p)), _mm256_cvtpd_ps(_mm256_loadu_pd(p + 4)));
  }
  GRANRAD_INLINE V load(const float* p) { return _mm256_loadu_ps(p); }
  GRANRAD_INLINE void store(float* p, V a) { _mm256_storeu_ps(p, a); }
  GRANRAD_INLINE V sqrt(V a) { return _mm256_sqrt_ps(a); }
  GRANRAD_INLINE V abs(V a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
  GRANRAD_INLINE V max(V a, V b) { return _mm256_max_ps(a, b); }
  GRANRAD_INLINE M less(V a, V b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
  GRANRAD_INLINE V select(M m, V a, V b) { return _mm256_blendv_ps(b, a, m); }
  GRANRAD_INLINE V keep(M m, V a) { return _mm256_and_ps(m, a); }
  GRANRAD_INLINE bool any(M m) { return _mm256_movemask_ps(m); }

  GRANRAD_INLINE V narrow(const Avx2Pack::V a[2]) {
    return join(_mm256_cvtpd_ps(a[0]), _mm256_cvtpd_ps(a[1]));
  }
  GRANRAD_INLINE void widen(V a, Avx2Pack::V out[2]) {
    out[0] = _mm256_cvtps_pd(_mm256_castps256_ps128(a));
    out[1] = _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1));
  }
  GRANRAD_INLINE __m256i to_fixed(Avx2Pack::V a) {
    const Avx2Pack::V magic = Avx2Pack::set(0x1.8p52);
    return _mm256_sub_epi64((__m256i)(a + magic), (__m256i)magic);
  }

  /// Rows r[l] = {a, b} of eight contacts to the columns of a and of b.
  GRANRAD_INLINE void transpose(const __m256 r[8], V a[3], V b[3]) {
    __m256 quad[2][3];  // {a_k | b_k} of four contacts
    for (int g = 0; g < 2; ++g) {
      const __m256* q = r + 4 * g;
      const __m256 low01 = _mm256_unpacklo_ps(q[0], q[1]), low23 = _mm256_unpacklo_ps(q[2], q[3]);
      const __m256 high01 = _mm256_unpackhi_ps(q[0], q[1]), high23 = _mm256_unpackhi_ps(q[2], q[3]);
      quad[g][0] = _mm256_shuffle_ps(low01, low23, 0x44);
      quad[g][1] = _mm256_shuffle_ps(low01, low23, 0xee);
      quad[g][2] = _mm256_shuffle_ps(high01, high23, 0x44);
    }
    for (int k = 0; k < 3; ++k) {
      a[k] = _mm256_permute2f128_ps(quad[0][k], quad[1][k], 0x20);
      b[k] = _mm256_permute2f128_ps(quad[0][k], quad[1][k], 0x31);
    }
  }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities(const Rows* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    const __m256 flip = _mm256_setr_ps(-0.0f, -0.0f, -0.0f, -0.0f, 0, 0, 0, 0);
    __m256 r[8];
    for (int l = 0; l < 8; ++l)
      r[l] = _mm256_add_ps(_mm256_load_ps(row_at(rows, i[l])->velocity),
                           _mm256_xor_ps(flip, _mm256_load_ps(row_at(rows, j[l])->velocity)));
    transpose(r, u, w);
  }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities_apart(const Rows* rows, const Index* i, const Index* j, V u[3], V wi[3],
                                            V wj[3]) {
    __m256 r[8], s[8];
    for (int l = 0; l < 8; ++l) {
      r[l] = _mm256_load_ps(row_at(rows, i[l])->velocity);
      s[l] = _mm256_load_ps(row_at(rows, j[l])->velocity);
    }
    V vi[3], vj[3];
    transpose(r, vi, wi), transpose(s, vj, wj);
    for (int k = 0; k < 3; ++k) u[k] = vi[k] - vj[k];
  }
};

}  // namespace granrad::native
