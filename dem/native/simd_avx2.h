#pragma once
#include <immintrin.h>

#include "dem/native/simd_scalar.h"

namespace granrad::native {

/// Four contacts at once in 256-bit registers. Operations as in ScalarPack.
struct Avx2Pack : LawInDouble<Avx2Pack> {
  static constexpr int width = 4;
  typedef double V __attribute__((vector_size(32)));
  using M = __m256d;
  using I = __m256i;

  GRANRAD_INLINE V set(double x) { return _mm256_set1_pd(x); }
  GRANRAD_INLINE V load(const double* p) { return _mm256_loadu_pd(p); }
  GRANRAD_INLINE void store(double* p, V a) { _mm256_storeu_pd(p, a); }
  GRANRAD_INLINE V sqrt(V a) { return _mm256_sqrt_pd(a); }
  GRANRAD_INLINE V abs(V a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
  GRANRAD_INLINE V max(V a, V b) { return _mm256_max_pd(a, b); }
  GRANRAD_INLINE V negate_where(M m, V a) { return _mm256_xor_pd(a, _mm256_and_pd(m, _mm256_set1_pd(-0.0))); }
  GRANRAD_INLINE M less(V a, V b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
  GRANRAD_INLINE V select(M m, V a, V b) { return _mm256_blendv_pd(b, a, m); }
  GRANRAD_INLINE V keep(M m, V a) { return _mm256_and_pd(m, a); }
  GRANRAD_INLINE bool any(M m) { return _mm256_movemask_pd(m); }
  GRANRAD_INLINE unsigned bits(M m) { return _mm256_movemask_pd(m); }
  GRANRAD_INLINE V round(V a) { return (a + set(0x1.8p52)) - set(0x1.8p52); }
  GRANRAD_INLINE void prefetch(const void* p) { __builtin_prefetch(p); }

  /// In two halves of 32 bits, each rounded by adding 1.5 x 2^52; the upper half is even in the units of the
  /// lower, so ties go to even as in one conversion.
  GRANRAD_INLINE I to_fixed(V a) {
    const V magic = set(0x1.8p52);
    const V upper = a * set(0x1p-32) + magic;
    const V lower = (a - (upper - magic) * set(0x1p32)) + magic;
    return _mm256_add_epi64(_mm256_slli_epi64((__m256i)upper, 32),
                            _mm256_sub_epi64((__m256i)lower, (__m256i)magic));
  }
  /// 64-bit integers to doubles, rounded once: 2^84 + 2^52 magic for the two halves.
  GRANRAD_INLINE __m256d from_fixed(__m256i q) {
    const __m256i lower = _mm256_blend_epi32(_mm256_set1_epi64x(0x4330000000000000), q, 0x55);
    const __m256i upper = _mm256_xor_si256(_mm256_srli_epi64(q, 32), _mm256_set1_epi64x(0x4530000080000000));
    const __m256d both = (__m256d)_mm256_set1_epi64x(0x4530000080100000);
    return _mm256_add_pd(_mm256_sub_pd((__m256d)upper, both), (__m256d)lower);
  }

  GRANRAD_INLINE void transpose(const __m256d r[4], V c[4]) {
    const __m256d l0 = _mm256_unpacklo_pd(r[0], r[1]), h0 = _mm256_unpackhi_pd(r[0], r[1]);
    const __m256d l1 = _mm256_unpacklo_pd(r[2], r[3]), h1 = _mm256_unpackhi_pd(r[2], r[3]);
    c[0] = _mm256_permute2f128_pd(l0, l1, 0x20), c[2] = _mm256_permute2f128_pd(l0, l1, 0x31);
    c[1] = _mm256_permute2f128_pd(h0, h1, 0x20), c[3] = _mm256_permute2f128_pd(h0, h1, 0x31);
  }
  template <class At, class Index>
  GRANRAD_INLINE void pair_positions(const At& at, const Index* i, const Index* j, V d[4]) {
    const __m256d flip = _mm256_setr_pd(-0.0, -0.0, -0.0, 0.0);
    __m256d r[4];
    for (int l = 0; l < 4; ++l)
      r[l] = _mm256_add_pd(_mm256_load_pd(at(i[l])), _mm256_xor_pd(flip, _mm256_load_pd(at(j[l]))));
    transpose(r, d);
  }
  template <class Index>
  GRANRAD_INLINE void pair_velocities(const double* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    __m256d a[4], b[4];
    for (int l = 0; l < 4; ++l) {
      const double *p = row_of<8>(rows, i[l]), *q = row_of<8>(rows, j[l]);
      a[l] = _mm256_sub_pd(_mm256_load_pd(p), _mm256_load_pd(q));
      b[l] = _mm256_add_pd(_mm256_load_pd(p + 4), _mm256_load_pd(q + 4));
    }
    V c[4], d[4];
    transpose(a, c), transpose(b, d);
    for (int k = 0; k < 3; ++k) u[k] = c[k], w[k] = d[k];
  }
  template <class Index>
  GRANRAD_INLINE void pair_velocities_apart(const double* rows, const Index* i, const Index* j, V u[3],
                                            V wi[3], V wj[3]) {
    V a[8], b[8];
    columns8(rows, i, a), columns8(rows, j, b);
    for (int k = 0; k < 3; ++k) u[k] = a[k] - b[k], wi[k] = a[k + 4], wj[k] = b[k + 4];
  }
  template <class Index>
  GRANRAD_INLINE void columns4(const double* rows, const Index* i, V c[4]) {
    __m256d r[4];
    for (int l = 0; l < 4; ++l) r[l] = _mm256_load_pd(row_of<4>(rows, i[l]));
    transpose(r, c);
  }
  template <class Index>
  GRANRAD_INLINE void columns8(const double* rows, const Index* i, V c[8]) {
    __m256d r[4], s[4];
    for (int l = 0; l < 4; ++l) {
      r[l] = _mm256_load_pd(row_of<8>(rows, i[l]));
      s[l] = _mm256_load_pd(row_of<8>(rows, i[l]) + 4);
    }
    transpose(r, c), transpose(s, c + 4);
  }
  GRANRAD_INLINE void to_rows(const I c[3], __m256i r[4]) {
    const V columns[4] = {(V)c[0], (V)c[1], (V)c[2], V{}};
    V rows[4];
    transpose(columns, rows);
    for (int l = 0; l < 4; ++l) r[l] = (__m256i)rows[l];
  }
  GRANRAD_INLINE void add_to(std::int64_t* p, __m256i a) {
    _mm256_store_si256((__m256i*)p, _mm256_add_epi64(_mm256_load_si256((const __m256i*)p), a));
  }
  template <class Index>
  GRANRAD_INLINE void add_pair(std::int64_t* rows, const Index* i, const Index* j, const I f[3],
                               const I t[3]) {
    __m256i a[4], b[4];
    to_rows(f, a), to_rows(t, b);
    for (int l = 0; l < 4; ++l) {
      std::int64_t *p = row_of<8>(rows, i[l]), *q = row_of<8>(rows, j[l]);
      add_to(p, a[l]), add_to(p + 4, b[l]);
      _mm256_store_si256((__m256i*)q, _mm256_sub_epi64(_mm256_load_si256((const __m256i*)q), a[l]));
      add_to(q + 4, b[l]);
    }
  }
  template <class Index>
  GRANRAD_INLINE void add_one(std::int64_t* rows, const Index* i, const I f[3], const I t[3]) {
    __m256i a[4], b[4];
    to_rows(f, a), to_rows(t, b);
    for (int l = 0; l < 4; ++l) {
      std::int64_t* p = row_of<8>(rows, i[l]);
      add_to(p, a[l]), add_to(p + 4, b[l]);
    }
  }

  struct Row {
    __m256d low, high;
  };
  GRANRAD_INLINE Row row_load(const double* p) { return {_mm256_load_pd(p), _mm256_load_pd(p + 4)}; }
  GRANRAD_INLINE void row_store(double* p, const Row& r) {
    _mm256_store_pd(p, r.low), _mm256_store_pd(p + 4, r.high);
  }
  GRANRAD_INLINE void copy_position(const double* from, double* to) {
    _mm256_store_pd(to, _mm256_load_pd(from));
  }
  GRANRAD_INLINE void row_narrow(float* p, const Row& r) {
    _mm_store_ps(p, _mm256_cvtpd_ps(r.low)), _mm_store_ps(p + 4, _mm256_cvtpd_ps(r.high));
  }
  GRANRAD_INLINE Row row_take(std::int64_t* p) {
    __m256i* q = (__m256i*)p;
    const Row r{from_fixed(_mm256_load_si256(q)), from_fixed(_mm256_load_si256(q + 1))};
    _mm256_store_si256(q, _mm256_setzero_si256()), _mm256_store_si256(q + 1, _mm256_setzero_si256());
    return r;
  }
  GRANRAD_INLINE Row row_multiply(const Row& a, const Row& b) {
    return {_mm256_mul_pd(a.low, b.low), _mm256_mul_pd(a.high, b.high)};
  }
  GRANRAD_INLINE Row row_add(const Row& a, const Row& b) {
    return {_mm256_add_pd(a.low, b.low), _mm256_add_pd(a.high, b.high)};
  }
  GRANRAD_INLINE bool row_too_fast(const Row& r, const double* reference) {
    const __m256d from = _mm256_load_pd(reference), change = abs(_mm256_sub_pd(r.low, from));
    return _mm256_movemask_pd(_mm256_cmp_pd(change, _mm256_permute4x64_pd(from, 0xff), _CMP_NLE_UQ)) & 7;
  }
  using Place = __m256d;
  GRANRAD_INLINE Place place_load(const double* p) { return _mm256_load_pd(p); }
  GRANRAD_INLINE void place_store(double* p, Place place) { _mm256_store_pd(p, place); }
  GRANRAD_INLINE Place place_drifted(Place place, const Row& r, double half, bool twice) {
    const __m256d move = _mm256_mul_pd(_mm256_setr_pd(half, half, half, 0.0), r.low);
    place = _mm256_add_pd(place, move);
    return twice ? _mm256_add_pd(place, move) : place;
  }

  GRANRAD_INLINE std::int64_t find_close(const float* x, const float* y, const float* z, const float* reach,
                                         const float p[4], const float period[3],
                                         const float inverse_period[3], std::int32_t first,
                                         std::int32_t count, std::int32_t* out) {
    std::int64_t found = 0;
    const float* c[3] = {x, y, z};
    for (std::int32_t q = 0; q < count; q += 8) {
      __m256 square = _mm256_setzero_ps();
      for (int k = 0; k < 3; ++k) {
        __m256 d = _mm256_sub_ps(_mm256_set1_ps(p[k]), _mm256_loadu_ps(c[k] + q));
        const __m256 images = _mm256_round_ps(_mm256_mul_ps(d, _mm256_set1_ps(inverse_period[k])), 8);
        d = _mm256_sub_ps(d, _mm256_mul_ps(_mm256_set1_ps(period[k]), images));
        square = _mm256_add_ps(square, _mm256_mul_ps(d, d));
      }
      const __m256 cut = _mm256_add_ps(_mm256_set1_ps(p[3]), _mm256_loadu_ps(reach + q));
      unsigned close = _mm256_movemask_ps(_mm256_cmp_ps(square, _mm256_mul_ps(cut, cut), _CMP_LT_OQ));
      if (count - q < 8) close &= (1u << (count - q)) - 1;
      for (; close; close &= close - 1) out[found++] = first + q + __builtin_ctz(close);
    }
    return found;
  }
};

}  // namespace granrad::native
