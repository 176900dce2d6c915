#include "raytrace/line_pass/line_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "dem/base/error.h"

namespace granrad {

PairPacking::PairPacking(std::size_t surfaces, double events, double per_block)
    : column_bits(static_cast<int>(std::bit_width(surfaces))), surfaces(surfaces) {
  if (column_bits > key_bits)
    throw InputError(advised(
        fmt::format("lines: {} surfaces (pairs are packed for fewer than 2^28)", surfaces), "try embree"));
  const double rows_per_block = per_block * static_cast<double>(surfaces) / events;
  row_bits = std::clamp(std::ilogb(std::max(1.0, rows_per_block)), 0, key_bits - column_bits);
}

void PairEvents::extend(Tail& tail) {
  if (used_ == chunks_.size()) chunks_.emplace_back();
  Chunk& chunk = chunks_[used_++];
  chunk.before = tail.chunk;
  tail = {chunk.event, chunk.event + Chunk::capacity, &chunk};
}

void PairEvents::collect(std::size_t block, std::vector<std::uint32_t>& events) const {
  const std::uint32_t* end = tails_[block].next;
  for (const Chunk* chunk = tails_[block].chunk; chunk; chunk = chunk->before) {
    events.insert(events.end(), chunk->event, end);
    if (chunk->before) end = chunk->before->event + Chunk::capacity;
  }
}

void PairEvents::clear() {
  std::fill(tails_.begin(), tails_.end(), Tail{});
  used_ = 0;
}

void sort_events(std::vector<std::uint32_t>& events, std::vector<std::uint32_t>& scratch, int key_bits) {
  constexpr int widest = 11;
  const int passes = (key_bits + widest - 1) / widest, digit = (key_bits + passes - 1) / passes;
  const std::uint32_t low = (1u << digit) - 1;
  scratch.resize(events.size());
  for (int pass = 0, shift = line_run_bits; pass < passes; ++pass, shift += digit) {
    std::uint32_t begin[1 << widest] = {}, sum = 0;
    for (const std::uint32_t e : events) ++begin[e >> shift & low];
    for (std::uint32_t d = 0; d <= low; ++d) sum += std::exchange(begin[d], sum);
    for (const std::uint32_t e : events) scratch[begin[e >> shift & low]++] = e;
    events.swap(scratch);
  }
}

}  // namespace granrad
