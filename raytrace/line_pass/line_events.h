#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "raytrace/line_pass/line_kernel.h"

namespace granrad {

/// Pairs of surfaces, in either order, as keys. The smaller number is the row of the pair; rows are taken in
/// blocks, and a key is (row within its block) << column_bits | larger number, so that keys of a block ascend
/// by row and column. Keys have `key_bits` at most: an event is a key and how often it was met, 1 .. 16, in
/// 32 bits, as a run of lines (line_kernel.h).
struct PairPacking {
  static constexpr int key_bits = 32 - line_run_bits;
  int column_bits, row_bits;
  std::size_t surfaces;

  /// Blocks that get about `per_block` of `events` events each, as far as keys allow. Throws InputError for
  /// 2^28 surfaces or more.
  PairPacking(std::size_t surfaces, double events, double per_block);

  std::size_t blocks() const { return ((surfaces - 1) >> row_bits) + 1; }
  std::size_t first_row(std::size_t block) const { return block << row_bits; }
  std::size_t block_of(std::uint32_t row) const { return row >> row_bits; }
  std::uint32_t key(std::uint32_t row, std::uint32_t column) const {
    return (row & ((1u << row_bits) - 1)) << column_bits | column;
  }
  std::size_t row(std::size_t block, std::uint32_t key) const {
    return first_row(block) + (key >> column_bits);
  }
  std::int32_t column(std::uint32_t key) const {
    return static_cast<std::int32_t>(key & ((1u << column_bits) - 1));
  }
};

/// Line ends found by one thread and not yet counted: a list of events for each block, in chunks that are
/// used again after each clear.
class PairEvents {
 public:
  explicit PairEvents(const PairPacking& packing) : packing_(packing), tails_(packing.blocks()) {}

  /// `a` and the surface of a run follow each other on lines; they are different.
  void add(std::int32_t a, std::uint32_t run) {
    const std::int32_t b = line_run_surface(run);
    const auto low = static_cast<std::uint32_t>(a < b ? a : b),
               high = static_cast<std::uint32_t>(a < b ? b : a);
    Tail& tail = tails_[packing_.block_of(low)];
    if (tail.next == tail.end) extend(tail);
    *tail.next++ = packing_.key(low, high) << line_run_bits | (line_run_count(run) - 1);
  }
  /// Appends the events of a block.
  void collect(std::size_t block, std::vector<std::uint32_t>& events) const;
  void clear();

 private:
  struct Chunk {
    static constexpr std::size_t capacity = 252;
    std::uint32_t event[capacity];
    Chunk* before;
  };
  struct Tail {
    std::uint32_t *next = nullptr, *end = nullptr;
    Chunk* chunk = nullptr;
  };
  void extend(Tail& tail);

  PairPacking packing_;
  std::vector<Tail> tails_;
  std::deque<Chunk> chunks_;
  std::size_t used_ = 0;
};

/// Sorts events by their keys of up to `key_bits` bits; `scratch` is room to work in.
void sort_events(std::vector<std::uint32_t>& events, std::vector<std::uint32_t>& scratch, int key_bits);

}  // namespace granrad
