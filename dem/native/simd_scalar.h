#pragma once
#include <cmath>
#include <cstdint>

#include "dem/native/law_numbers.h"

namespace granrad::native {

/// The instruction sets differ in their pack: `width` contacts worked on at once. Every pack offers the same
/// operations with the same rounding (IEEE, nothing fused), so that all give the same bits. Rows are arrays
/// indexed by particle: position {x, y, z, reach}, velocity {v, limit, omega, -}, force {F, -, torque, -} in
/// fixed point. This one works on a single contact in plain C++ and needs no instruction set at all.
struct ScalarPack : LawInDouble<ScalarPack> {
  static constexpr int width = 1;
  using V = double;        ///< `width` doubles
  using M = bool;          ///< a mask, one truth value a lane
  using I = std::int64_t;  ///< `width` integers

  GRANRAD_INLINE V set(double x) { return x; }
  GRANRAD_INLINE V load(const double* p) { return *p; }
  GRANRAD_INLINE void store(double* p, V a) { *p = a; }
  GRANRAD_INLINE V sqrt(V a) { return __builtin_sqrt(a); }
  GRANRAD_INLINE V abs(V a) { return __builtin_fabs(a); }
  GRANRAD_INLINE V max(V a, V b) { return a > b ? a : b; }
  GRANRAD_INLINE V negate_where(M m, V a) { return m ? -a : a; }
  GRANRAD_INLINE M less(V a, V b) { return a < b; }
  GRANRAD_INLINE V select(M m, V a, V b) { return m ? a : b; }
  GRANRAD_INLINE V keep(M m, V a) { return m ? a : 0.0; }  ///< zero where the mask is false
  GRANRAD_INLINE bool any(M m) { return m; }
  GRANRAD_INLINE unsigned bits(M m) { return m; }
  /// To the nearest integer, ties to even, of |a| < 2^51.
  GRANRAD_INLINE V round(V a) { return (a + 0x1.8p52) - 0x1.8p52; }
  /// To the nearest integer, ties to even, of |a| < 2^63.
  GRANRAD_INLINE I to_fixed(V a) { return __builtin_llrint(a); }
  GRANRAD_INLINE void prefetch(const void* p) { __builtin_prefetch(p); }

  /// d: difference of the positions and sum of the reaches.
  template <class At, class Index>
  GRANRAD_INLINE void pair_positions(const At& at, const Index* i, const Index* j, V d[4]) {
    const double *a = at(*i), *b = at(*j);
    for (int k = 0; k < 3; ++k) d[k] = a[k] - b[k];
    d[3] = a[3] + b[3];
  }
  /// u: difference of the velocities, w: sum of the spins.
  template <class Index>
  GRANRAD_INLINE void pair_velocities(const double* rows, const Index* i, const Index* j, V u[3], V w[3]) {
    const double *a = row_of<8>(rows, *i), *b = row_of<8>(rows, *j);
    for (int k = 0; k < 3; ++k) u[k] = a[k] - b[k], w[k] = a[k + 4] + b[k + 4];
  }
  /// u: difference of the velocities, wi and wj: the two spins.
  template <class Index>
  GRANRAD_INLINE void pair_velocities_apart(const double* rows, const Index* i, const Index* j, V u[3],
                                            V wi[3], V wj[3]) {
    const double *a = row_of<8>(rows, *i), *b = row_of<8>(rows, *j);
    for (int k = 0; k < 3; ++k) u[k] = a[k] - b[k], wi[k] = a[k + 4], wj[k] = b[k + 4];
  }
  /// Four columns of rows of four doubles.
  template <class Index>
  GRANRAD_INLINE void columns4(const double* rows, const Index* i, V c[4]) {
    for (int k = 0; k < 4; ++k) c[k] = row_of<4>(rows, *i)[k];
  }
  /// Eight columns of rows of eight doubles.
  template <class Index>
  GRANRAD_INLINE void columns8(const double* rows, const Index* i, V c[8]) {
    for (int k = 0; k < 8; ++k) c[k] = row_of<8>(rows, *i)[k];
  }
  /// Adds (f, t) to the force rows of i, (-f, t) to those of j. Rows may repeat.
  template <class Index>
  GRANRAD_INLINE void add_pair(std::int64_t* rows, const Index* i, const Index* j, const I f[3],
                               const I t[3]) {
    std::int64_t *a = row_of<8>(rows, *i), *b = row_of<8>(rows, *j);
    for (int k = 0; k < 3; ++k) a[k] += f[k], a[k + 4] += t[k], b[k] -= f[k], b[k + 4] += t[k];
  }
  /// Adds (f, t) to the force rows of i.
  template <class Index>
  GRANRAD_INLINE void add_one(std::int64_t* rows, const Index* i, const I f[3], const I t[3]) {
    std::int64_t* a = row_of<8>(rows, *i);
    for (int k = 0; k < 3; ++k) a[k] += f[k], a[k + 4] += t[k];
  }

  /// One particle row of eight numbers.
  struct Row {
    double lane[8];
  };
  GRANRAD_INLINE Row row_load(const double* p) {
    Row r;
    for (int k = 0; k < 8; ++k) r.lane[k] = p[k];
    return r;
  }
  GRANRAD_INLINE void row_store(double* p, const Row& r) {
    for (int k = 0; k < 8; ++k) p[k] = r.lane[k];
  }
  GRANRAD_INLINE void copy_position(const double* from, double* to) {
    for (int k = 0; k < 4; ++k) to[k] = from[k];
  }
  GRANRAD_INLINE void row_narrow(float* p, const Row& r) {
    for (int k = 0; k < 8; ++k) p[k] = static_cast<float>(r.lane[k]);
  }
  /// Reads a force row as doubles and clears it.
  GRANRAD_INLINE Row row_take(std::int64_t* p) {
    Row r;
    for (int k = 0; k < 8; ++k) r.lane[k] = double(p[k]), p[k] = 0;
    return r;
  }
  GRANRAD_INLINE Row row_multiply(const Row& a, const Row& b) {
    Row r;
    for (int k = 0; k < 8; ++k) r.lane[k] = a.lane[k] * b.lane[k];
    return r;
  }
  GRANRAD_INLINE Row row_add(const Row& a, const Row& b) {
    Row r;
    for (int k = 0; k < 8; ++k) r.lane[k] = a.lane[k] + b.lane[k];
    return r;
  }
  /// True unless |v - reference| <= reference[3] in all three directions.
  GRANRAD_INLINE bool row_too_fast(const Row& r, const double* reference) {
    bool fine = true;
    for (int k = 0; k < 3; ++k) fine &= __builtin_fabs(r.lane[k] - reference[k]) <= reference[3];
    return !fine;
  }
  /// A row of four numbers, of which three are a place.
  struct Place {
    double lane[4];
  };
  GRANRAD_INLINE Place place_load(const double* p) { return {{p[0], p[1], p[2], p[3]}}; }
  GRANRAD_INLINE void place_store(double* p, const Place& place) {
    for (int k = 0; k < 4; ++k) p[k] = place.lane[k];
  }
  /// place + half v, `twice` or once; rounded each time.
  GRANRAD_INLINE Place place_drifted(Place place, const Row& r, double half, bool twice) {
    for (int k = 0; k < 3; ++k) {
      const double move = half * r.lane[k];
      place.lane[k] += move;
      if (twice) place.lane[k] += move;
    }
    return place;
  }

  /// Appends to out the numbers first + q of those q < count (from memory, in packs) that are closer than
  /// their cutoff to point p; returns how many. Reads and writes up to 16 entries beyond the end.
  GRANRAD_INLINE std::int64_t find_close(const float* x, const float* y, const float* z, const float* reach,
                                         const float p[4], const float period[3],
                                         const float inverse_period[3], std::int32_t first,
                                         std::int32_t count, std::int32_t* out) {
    std::int64_t found = 0;
    for (std::int32_t q = 0; q < count; ++q) {
      float d[3] = {p[0] - x[q], p[1] - y[q], p[2] - z[q]};
      for (int k = 0; k < 3; ++k) d[k] -= period[k] * ((d[k] * inverse_period[k] + 0x1.8p23f) - 0x1.8p23f);
      const float cut = p[3] + reach[q];
      out[found] = first + q;
      found += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < cut * cut;
    }
    return found;
  }
};

}  // namespace granrad::native
