#pragma once
#include <immintrin.h>

#include "dem/native/simd_scalar.h"

namespace granrad::native {

/// Eight contacts at once in 512-bit registers; a particle row is one register. Operations as in ScalarPack.
struct Avx512Pack : LawInDouble<Avx512Pack> {
  static constexpr int width = 8;
  typedef double V __attribute__((vector_size(64)));
  using M = __mmask8;
  using I = __m512i;

  GRANRAD_INLINE V set(double x) { return _mm512_set1_pd(x); }
  GRANRAD_INLINE V load(const double* p) { return _mm512_loadu_pd(p); }
  GRANRAD_INLINE void store(double* p, V a) { _mm512_storeu_pd(p, a); }
  GRANRAD_INLINE V sqrt(V a) { return _mm512_sqrt_pd(a); }
  GRANRAD_INLINE V abs(V a) { return _mm512_abs_pd(a); }
  GRANRAD_INLINE V max(V a, V b) { return _mm512_max_pd(a, b); }
  GRANRAD_INLINE V negate_where(M m, V a) { return _mm512_mask_xor_pd(a, m, a, _mm512_set1_pd(-0.0)); }
  GRANRAD_INLINE M less(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  GRANRAD_INLINE V select(M m, V a, V b) { return _mm512_mask_mov_pd(b, m, a); }
  GRANRAD_INLINE V keep(M m, V a) { return _mm512_maskz_mov_pd(m, a); }
  GRANRAD_INLINE bool any(M m) { return m; }
  GRANRAD_INLINE unsigned bits(M m) { return m; }
  GRANRAD_INLINE V round(V a) { return (a + set(0x1.8p52)) - set(0x1.8p52); }
  GRANRAD_INLINE I to_fixed(V a) { return _mm512_cvtpd_epi64(a); }
  GRANRAD_INLINE void prefetch(const void* p) { __builtin_prefetch(p); }

  /// Eight rows of eight to eight columns.
  GRANRAD_INLINE void transpose(const __m512d r[8], V c[8]) {
    const __m512d e01 = _mm512_unpacklo_pd(r[0], r[1]), o01 = _mm512_unpackhi_pd(r[0], r[1]);
    const __m512d e23 = _mm512_unpacklo_pd(r[2], r[3]), o23 = _mm512_unpackhi_pd(r[2], r[3]);
    const __m512d e45 = _mm512_unpacklo_pd(r[4], r[5]), o45 = _mm512_unpackhi_pd(r[4], r[5]);
    const __m512d e67 = _mm512_unpacklo_pd(r[6], r[7]), o67 = _mm512_unpackhi_pd(r[6], r[7]);
    const __m512d e04 = _mm512_shuffle_f64x2(e01, e23, 0x88), e26 = _mm512_shuffle_f64x2(e01, e23, 0xdd);
    const __m512d f04 = _mm512_shuffle_f64x2(e45, e67, 0x88), f26 = _mm512_shuffle_f64x2(e45, e67, 0xdd);
    const __m512d o15 = _mm512_shuffle_f64x2(o01, o23, 0x88), o37 = _mm512_shuffle_f64x2(o01, o23, 0xdd);
    const __m512d p15 = _mm512_shuffle_f64x2(o45, o67, 0x88), p37 = _mm512_shuffle_f64x2(o45, o67, 0xdd);
    c[0] = _mm512_shuffle_f64x2(e04, f04, 0x88), c[4] = _mm512_shuffle_f64x2(e04, f04, 0xdd);
    c[2] = _mm512_shuffle_f64x2(e26, f26, 0x88), c[6] = _mm512_shuffle_f64x2(e26, f26, 0xdd);
    c[1] = _mm512_shuffle_f64x2(o15, p15, 0x88), c[5] = _mm512_shuffle_f64x2(o15, p15, 0xdd);
    c[3] = _mm512_shuffle_f64x2(o37, p37, 0x88), c[7] = _mm512_shuffle_f64x2(o37, p37, 0xdd);
  }
  /// Eight rows of four to four columns.
  GRANRAD_INLINE void transpose4(const __m256d r[8], V c[4]) {
    __m512d both[4];
    for (int l = 0; l < 4; ++l) both[l] = _mm512_insertf64x4(_mm512_castpd256_pd512(r[l]), r[l + 4], 1);
    const __m512d l0 = _mm512_unpacklo_pd(both[0], both[1]), h0 = _mm512_unpackhi_pd(both[0], both[1]);
    const __m512d l1 = _mm512_unpacklo_pd(both[2], both[3]), h1 = _mm512_unpackhi_pd(both[2], both[3]);
    const __m512i even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    const __m512i odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    c[0] = _mm512_permutex2var_pd(l0, even, l1), c[2] = _mm512_permutex2var_pd(l0, odd, l1);
    c[1] = _mm512_permutex2var_pd(h0, even, h1), c[3] = _mm512_permutex2var_pd(h0, odd, h1);
  }
  template <class At, class Index>
  GRANRAD_INLINE void pair_positions(const At& at, const Index* i, const Index* j, V d[4]) {
    const __m256d sign = _mm256_setr_pd(-1, -1, -1, 1);  // a product with +-1 is exact, so fusing it is too
    __m256d r[8];
    for (int l = 0; l < 8; ++l)
      r[l] = _mm256_fmadd_pd(sign, _mm256_load_pd(at(j[l])), _mm256_load_pd(at(i[l])));
    transpose4(r, d);
  }
  template <class Index>
  GRANRAD_INLINE void pair_velocities(const double* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    const __m512d sign = _mm512_setr_pd(-1, -1, -1, -1, 1, 1, 1, 1);
    __m512d r[8];
    for (int l = 0; l < 8; ++l)
      r[l] =
          _mm512_fmadd_pd(sign, _mm512_load_pd(row_of<8>(rows, j[l])), _mm512_load_pd(row_of<8>(rows, i[l])));
    V c[8];
    transpose(r, c);
    for (int k = 0; k < 3; ++k) u[k] = c[k], w[k] = c[k + 4];
  }
  template <class Index>
  GRANRAD_INLINE void pair_velocities_apart(const double* rows, const Index* i, const Index* j, V u[3],
                                            V wi[3], V wj[3]) {
    __m512d r[8];
    __m256d s[8];
    for (int l = 0; l < 8; ++l) {
      const __m512d a = _mm512_load_pd(row_of<8>(rows, i[l]));
      r[l] = _mm512_mask_sub_pd(a, 0x0f, a, _mm512_load_pd(row_of<8>(rows, j[l])));
      s[l] = _mm256_load_pd(row_of<8>(rows, j[l]) + 4);
    }
    V c[8], d[4];
    transpose(r, c), transpose4(s, d);
    for (int k = 0; k < 3; ++k) u[k] = c[k], wi[k] = c[k + 4], wj[k] = d[k];
  }
  template <class Index>
  GRANRAD_INLINE void columns4(const double* rows, const Index* i, V c[4]) {
    __m256d r[8];
    for (int l = 0; l < 8; ++l) r[l] = _mm256_load_pd(row_of<4>(rows, i[l]));
    transpose4(r, c);
  }
  template <class Index>
  GRANRAD_INLINE void columns8(const double* rows, const Index* i, V c[8]) {
    __m512d r[8];
    for (int l = 0; l < 8; ++l) r[l] = _mm512_load_pd(row_of<8>(rows, i[l]));
    transpose(r, c);
  }
  GRANRAD_INLINE void to_rows(const I f[3], const I t[3], __m512i r[8]) {
    const __m512d columns[8] = {(__m512d)f[0], (__m512d)f[1], (__m512d)f[2], _mm512_setzero_pd(),
                                (__m512d)t[0], (__m512d)t[1], (__m512d)t[2], _mm512_setzero_pd()};
    V rows[8];
    transpose(columns, rows);
    for (int l = 0; l < 8; ++l) r[l] = (__m512i)rows[l];
  }
  template <class Index>
  GRANRAD_INLINE void add_pair(std::int64_t* rows, const Index* i, const Index* j, const I f[3],
                               const I t[3]) {
    __m512i r[8];
    to_rows(f, t, r);
    for (int l = 0; l < 8; ++l) {
      std::int64_t *a = row_of<8>(rows, i[l]), *b = row_of<8>(rows, j[l]);
      _mm512_store_si512(a, _mm512_add_epi64(_mm512_load_si512(a), r[l]));
      const __m512i old = _mm512_load_si512(b);
      _mm512_store_si512(b, _mm512_mask_sub_epi64(_mm512_add_epi64(old, r[l]), 0x0f, old, r[l]));
    }
  }
  template <class Index>
  GRANRAD_INLINE void add_one(std::int64_t* rows, const Index* i, const I f[3], const I t[3]) {
    __m512i r[8];
    to_rows(f, t, r);
    for (int l = 0; l < 8; ++l) {
      std::int64_t* a = row_of<8>(rows, i[l]);
      _mm512_store_si512(a, _mm512_add_epi64(_mm512_load_si512(a), r[l]));
    }
  }

  using Row = __m512d;
  GRANRAD_INLINE Row row_load(const double* p) { return _mm512_load_pd(p); }
  GRANRAD_INLINE void row_store(double* p, Row r) { _mm512_store_pd(p, r); }
  GRANRAD_INLINE void copy_position(const double* from, double* to) {
    _mm256_store_pd(to, _mm256_load_pd(from));
  }
  GRANRAD_INLINE void row_narrow(float* p, Row r) { _mm256_store_ps(p, _mm512_cvtpd_ps(r)); }
  GRANRAD_INLINE Row row_take(std::int64_t* p) {
    const Row r = _mm512_cvtepi64_pd(_mm512_load_si512(p));
    _mm512_store_si512(p, _mm512_setzero_si512());
    return r;
  }
  GRANRAD_INLINE Row row_multiply(Row a, Row b) { return _mm512_mul_pd(a, b); }
  GRANRAD_INLINE Row row_add(Row a, Row b) { return _mm512_add_pd(a, b); }
  GRANRAD_INLINE bool row_too_fast(Row r, const double* reference) {
    const __m256d v = _mm512_castpd512_pd256(r);
    const __m256d from = _mm256_load_pd(reference);
    const __m256d change = _mm256_andnot_pd(_mm256_set1_pd(-0.0), _mm256_sub_pd(v, from));
    return _mm256_cmp_pd_mask(change, _mm256_permute4x64_pd(from, 0xff), _CMP_NLE_UQ) & 7;
  }
  using Place = __m256d;
  GRANRAD_INLINE Place place_load(const double* p) { return _mm256_load_pd(p); }
  GRANRAD_INLINE void place_store(double* p, Place place) { _mm256_store_pd(p, place); }
  GRANRAD_INLINE Place place_drifted(Place place, Row r, double half, bool twice) {
    const __m256d move = _mm256_mul_pd(_mm256_setr_pd(half, half, half, 0.0), _mm512_castpd512_pd256(r));
    place = _mm256_add_pd(place, move);
    return twice ? _mm256_add_pd(place, move) : place;
  }

  GRANRAD_INLINE std::int64_t find_close(const float* x, const float* y, const float* z, const float* reach,
                                         const float p[4], const float period[3],
                                         const float inverse_period[3], std::int32_t first,
                                         std::int32_t count, std::int32_t* out) {
    std::int64_t found = 0;
    const float* c[3] = {x, y, z};
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (std::int32_t q = 0; q < count; q += 16) {
      __m512 square = _mm512_setzero_ps();
      for (int k = 0; k < 3; ++k) {
        __m512 d = _mm512_sub_ps(_mm512_set1_ps(p[k]), _mm512_loadu_ps(c[k] + q));
        const __m512 images = _mm512_roundscale_ps(_mm512_mul_ps(d, _mm512_set1_ps(inverse_period[k])), 8);
        d = _mm512_sub_ps(d, _mm512_mul_ps(_mm512_set1_ps(period[k]), images));
        square = _mm512_add_ps(square, _mm512_mul_ps(d, d));
      }
      const __m512 cut = _mm512_add_ps(_mm512_set1_ps(p[3]), _mm512_loadu_ps(reach + q));
      __mmask16 close = _mm512_cmp_ps_mask(square, _mm512_mul_ps(cut, cut), _CMP_LT_OQ);
      if (count - q < 16) close &= (1u << (count - q)) - 1;
      const __m512i number = _mm512_add_epi32(_mm512_set1_epi32(first + q), lane);
      _mm512_storeu_si512(out + found, _mm512_maskz_compress_epi32(close, number));
      found += __builtin_popcount(close);
    }
    return found;
  }
};

}  // namespace granrad::native
