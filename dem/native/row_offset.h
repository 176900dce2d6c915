#pragma once
#include <cstdint>

#define GRANRAD_INLINE [[gnu::always_inline]] static inline

namespace granrad::native {

/// The number of a row, kept as the bytes before it in a column of four doubles a row: kernels find rows of four
/// and of eight doubles by it without a shift, of which each contact would need ten.
struct RowOffset {
  static constexpr std::int32_t row_bytes = 32;
  static constexpr std::int64_t most_rows = std::int64_t{1} << 26;

  RowOffset() = default;
  [[gnu::always_inline]] RowOffset(std::int32_t row) : bytes(row * row_bytes) {}
  [[gnu::always_inline]] operator std::int32_t() const { return bytes / row_bytes; }
  std::int32_t bytes;
};

/// Row i of `rows`, whose type is a whole row.
template <class Row>
GRANRAD_INLINE Row* row_at(Row* rows, RowOffset i) {
  static_assert(sizeof(Row) % RowOffset::row_bytes == 0);
  constexpr std::int64_t stride = sizeof(Row) / RowOffset::row_bytes;
  return (Row*)((char*)rows + stride * std::int64_t(i.bytes));
}
template <class Row>
GRANRAD_INLINE Row* row_at(Row* rows, std::int32_t i) {
  return rows + i;
}

/// Row i of rows of `width` numbers of eight bytes each.
template <int width, class Number>
GRANRAD_INLINE Number* row_of(Number* rows, RowOffset i) {
  return (Number*)((char*)rows + width / 4 * std::int64_t(i.bytes));
}
template <int width, class Number>
GRANRAD_INLINE Number* row_of(Number* rows, std::int32_t i) {
  return rows + width * std::int64_t(i);
}

}  // namespace granrad::native
