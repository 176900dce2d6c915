#pragma once
#include <cstdint>

#define GRANRAD_INLINE [[gnu::always_inline]] static inline

namespace granrad::native {

/// What a pack needs beside its operations to work the law of contacts in double precision (pair_bodies.h):
/// it is its own wide pack, so that numbers are neither narrowed nor widened.
template <class Pack>
struct LawInDouble {
  using Wide = Pack;
  using Lane = double;
  static constexpr int halves = 1;
  template <class V>
  GRANRAD_INLINE V narrow(const V a[1]) {
    return a[0];
  }
  template <class V>
  GRANRAD_INLINE void widen(V a, V out[1]) {
    out[0] = a;
  }
  template <class V>
  GRANRAD_INLINE V overlap(V sum, V distance, V) {
    return sum - distance;
  }
  template <class Rows>
  GRANRAD_INLINE const double* motion(const Rows& rows) {
    return rows.velocity;
  }
  template <class Rows>
  GRANRAD_INLINE const double* position(const Rows& rows, std::int64_t i) {
    return rows.position + 4 * i;
  }
  template <class Rows>
  GRANRAD_INLINE void prefetch_row(const Rows& rows, std::int64_t i) {
    __builtin_prefetch(rows.position + 4 * i), __builtin_prefetch(rows.velocity + 8 * i);
  }
  template <class Contacts>
  GRANRAD_INLINE double* const* springs(const Contacts& c) {
    return c.displacement;
  }
};

/// The same for the law in single precision: velocities and springs stand in memory as floats.
struct LawInSingle {
  using Lane = float;
  /// sum - distance without its cancellation: (sum^2 - distance^2) / (sum + distance), the excess from
  /// double.
  template <class V>
  GRANRAD_INLINE V overlap(V sum, V distance, V excess) {
    return excess / (sum + distance);
  }
  template <class Rows>
  GRANRAD_INLINE const auto* motion(const Rows& rows) {
    return rows.mixed;
  }
  template <class Rows>
  GRANRAD_INLINE const double* position(const Rows& rows, std::int64_t i) {
    return rows.mixed[i].position;
  }
  template <class Rows>
  GRANRAD_INLINE void prefetch_row(const Rows& rows, std::int64_t i) {
    __builtin_prefetch(rows.mixed + i);
  }
  template <class Contacts>
  GRANRAD_INLINE float* const* springs(const Contacts& c) {
    return c.rounded;
  }
};

}  // namespace granrad::native
