#pragma once
#include <cstdint>

#include "dem/native/row_offset.h"

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
  GRANRAD_INLINE const double* position(const Rows& rows, RowOffset i) {
    return row_of<4>(rows.position, i);
  }
  template <class Rows>
  GRANRAD_INLINE void prefetch_row(const Rows& rows, RowOffset i) {
    __builtin_prefetch(row_of<4>(rows.position, i)), __builtin_prefetch(row_of<8>(rows.velocity, i));
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
  GRANRAD_INLINE const double* position(const Rows& rows, RowOffset i) {
    return row_at(rows.mixed, i)->position;
  }
  template <class Rows>
  GRANRAD_INLINE void prefetch_row(const Rows& rows, RowOffset i) {
    __builtin_prefetch(row_at(rows.mixed, i));
  }
  template <class Contacts>
  GRANRAD_INLINE float* const* springs(const Contacts& c) {
    return c.rounded;
  }
};

}  // namespace granrad::native
