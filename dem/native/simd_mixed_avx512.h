#pragma once
#include "dem/native/simd_avx512.h"

namespace granrad::native {

/// The law of sixteen contacts at once in single precision. Operations as in ScalarMixed, same rounding.
struct Avx512Mixed : LawInSingle {
  static constexpr int width = 16;
  typedef float V __attribute__((vector_size(64)));
  using M = __mmask16;
  using Wide = Avx512Pack;
  static constexpr int halves = 2;

  GRANRAD_INLINE V set(double x) { return _mm512_set1_ps(static_cast<float>(x)); }
  GRANRAD_INLINE V join(__m256 low, __m256 high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
  }
  GRANRAD_INLINE V load(const double* p) {
    return join(_mm512_cvtpd_ps(_mm512_loadu_pd(p)), _mm512_cvtpd_ps(_mm512_loadu_pd(p + 8)));
  }
  GRANRAD_INLINE V load(const float* p) { return _mm512_loadu_ps(p); }
  GRANRAD_INLINE void store(float* p, V a) { _mm512_storeu_ps(p, a); }
  GRANRAD_INLINE V sqrt(V a) { return _mm512_sqrt_ps(a); }
  GRANRAD_INLINE V abs(V a) { return _mm512_abs_ps(a); }
  GRANRAD_INLINE V max(V a, V b) { return _mm512_max_ps(a, b); }
  GRANRAD_INLINE M less(V a, V b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  GRANRAD_INLINE V select(M m, V a, V b) { return _mm512_mask_mov_ps(b, m, a); }
  GRANRAD_INLINE V keep(M m, V a) { return _mm512_maskz_mov_ps(m, a); }
  GRANRAD_INLINE bool any(M m) { return m; }

  GRANRAD_INLINE V narrow(const Avx512Pack::V a[2]) {
    return join(_mm512_cvtpd_ps(a[0]), _mm512_cvtpd_ps(a[1]));
  }
  GRANRAD_INLINE void widen(V a, Avx512Pack::V out[2]) {
    out[0] = _mm512_cvtps_pd(_mm512_castps512_ps256(a));
    out[1] = _mm512_cvtps_pd(_mm512_extractf32x8_ps(a, 1));
  }
  GRANRAD_INLINE __m512i to_fixed(Avx512Pack::V a) { return Avx512Pack::to_fixed(a); }

  /// Rows of contacts `row` and `row + 4`.
  template <class Rows, class Index>
  GRANRAD_INLINE __m512 two_rows(const Rows* rows, const Index* row) {
    return join(_mm256_load_ps(row_at(rows, row[0])->velocity),
                _mm256_load_ps(row_at(rows, row[4])->velocity));
  }
  /// Rows {a, b} of sixteen contacts to the columns of a and of b. r[l] holds contacts l and l + 4 for l < 4,
  /// l + 4 and l + 8 else.
  GRANRAD_INLINE void transpose(const __m512 r[8], V a[3], V b[3]) {
    __m512 quad[2][3];  // {a_k | b_k | a_k | b_k}, each of four contacts
    for (int g = 0; g < 2; ++g) {
      const __m512* q = r + 4 * g;
      const __m512 low01 = _mm512_unpacklo_ps(q[0], q[1]), low23 = _mm512_unpacklo_ps(q[2], q[3]);
      const __m512 high01 = _mm512_unpackhi_ps(q[0], q[1]), high23 = _mm512_unpackhi_ps(q[2], q[3]);
      quad[g][0] = _mm512_shuffle_ps(low01, low23, 0x44);
      quad[g][1] = _mm512_shuffle_ps(low01, low23, 0xee);
      quad[g][2] = _mm512_shuffle_ps(high01, high23, 0x44);
    }
    for (int k = 0; k < 3; ++k) {
      a[k] = _mm512_shuffle_f32x4(quad[0][k], quad[1][k], 0x88);
      b[k] = _mm512_shuffle_f32x4(quad[0][k], quad[1][k], 0xdd);
    }
  }
  GRANRAD_INLINE int first_of(int l) { return l < 4 ? l : l + 4; }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities(const Rows* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    const __m256 half = _mm256_setr_ps(-0.0f, -0.0f, -0.0f, -0.0f, 0, 0, 0, 0);
    const __m512 flip = join(half, half);
    __m512 r[8];
    for (int l = 0; l < 8; ++l)
      r[l] = _mm512_add_ps(two_rows(rows, i + first_of(l)),
                           _mm512_xor_ps(flip, two_rows(rows, j + first_of(l))));
    transpose(r, u, w);
  }
  template <class Rows, class Index>
  GRANRAD_INLINE void pair_velocities_apart(const Rows* rows, const Index* i, const Index* j, V u[3], V wi[3],
                                            V wj[3]) {
    __m512 r[8], s[8];
    for (int l = 0; l < 8; ++l)
      r[l] = two_rows(rows, i + first_of(l)), s[l] = two_rows(rows, j + first_of(l));
    V vi[3], vj[3];
    transpose(r, vi, wi), transpose(s, vj, wj);
    for (int k = 0; k < 3; ++k) u[k] = vi[k] - vj[k];
  }
};

}  // namespace granrad::native
