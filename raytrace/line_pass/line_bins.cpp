#include "raytrace/line_pass/line_bins.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace granrad {

namespace {

constexpr std::int32_t spheres_at_once = 1024;  // their discs stay in the first-level cache
constexpr std::int32_t discs_per_bin = 4096;    // 80 KB
constexpr std::uint64_t depths = std::uint64_t{1} << line_key_bits;

}  // namespace

void LineBins::fill(const LineKernels& kernels, const LineSpheres& spheres, const LineLattice& lattice,
                    const LineProjection& projection) {
  slabs_ = spheres.count / lattice.tiles() / discs_per_bin + 1;
  bins_.assign(static_cast<std::size_t>(lattice.tiles()) * static_cast<std::size_t>(slabs_), Bin{});
  used_ = 0;
  if (bins_.size() == 1) {
    projected_.resize(static_cast<std::size_t>(spheres.count));
    kernels.project(spheres, 0, spheres.count, projection, projected_.data());
    for (LineRecord& disc : projected_) disc.cell = lattice.cell(0, disc.cell & 0xffff, disc.cell >> 16);
    return;
  }
  projected_.resize(spheres_at_once);
  const std::int32_t shift = lattice.tile_shift, within = (1 << shift) - 1;
  const auto slabs = static_cast<std::uint64_t>(slabs_);
  for (std::int32_t i = 0; i < spheres.count; i += spheres_at_once) {
    const std::int32_t end = std::min(spheres.count, i + spheres_at_once);
    kernels.project(spheres, i, end, projection, projected_.data());
    for (std::int32_t k = i; k < end; ++k) {
      const LineRecord& disc = projected_[static_cast<std::size_t>(k - i)];
      const std::int32_t column = disc.cell & 0xffff, row = disc.cell >> 16;
      const auto width = static_cast<std::int32_t>(2 * spheres.reach[k]);
      const auto slab = static_cast<std::int32_t>(disc.key * slabs >> line_key_bits);
      if (std::max(column & within, row & within) + width <= within) {
        put(disc, slab, column >> shift, row >> shift, lattice);
        continue;
      }
      const std::int32_t right = std::min((column + width) >> shift, lattice.tiles_across - 1);
      const std::int32_t bottom = std::min((row + width) >> shift, lattice.tiles_down - 1);
      for (std::int32_t down = row >> shift; down <= bottom; ++down)
        for (std::int32_t across = column >> shift; across <= right; ++across)
          put(disc, slab, across, down, lattice);
    }
  }
}

inline void LineBins::put(const LineRecord& disc, std::int32_t slab, std::int32_t across, std::int32_t down,
                          const LineLattice& lattice) {
  const std::int32_t tile = down * lattice.tiles_across + across;
  Bin& bin = bins_[static_cast<std::size_t>(tile) * static_cast<std::size_t>(slabs_) +
                   static_cast<std::size_t>(slab)];
  if (bin.to == bin.end) extend(bin);
  const std::int32_t column = (disc.cell & 0xffff) - (across << lattice.tile_shift) + lattice.margin;
  const std::int32_t row = (disc.cell >> 16) - (down << lattice.tile_shift) + lattice.margin;
  *bin.to++ = {disc.du, disc.dv, row * lattice.pitch + column, disc.sphere, disc.key};
}

void LineBins::extend(Bin& bin) {
  if (used_ == chunks_.size()) chunks_.emplace_back();
  Chunk& chunk = chunks_[used_++];
  chunk.next = nullptr;
  (bin.last ? bin.last->next : bin.first) = &chunk;
  bin = {chunk.record, chunk.record + Chunk::capacity, bin.first, &chunk};
}

template <class Visit>
void LineBins::for_records(const Bin& bin, Visit&& visit) const {
  for (const Chunk* chunk = bin.first; chunk; chunk = chunk->next) {
    const LineRecord* end = chunk == bin.last ? bin.to : chunk->record + Chunk::capacity;
    for (const LineRecord* r = chunk->record; r < end; ++r) visit(*r);
  }
}

std::size_t LineBins::count(const Bin& bin) const {
  std::size_t n = 0;
  for (const Chunk* chunk = bin.first; chunk; chunk = chunk->next)
    n += static_cast<std::size_t>((chunk == bin.last ? bin.to : chunk->record + Chunk::capacity) -
                                  chunk->record);
  return n;
}

/// Appends `count` discs of a slab, by the low and then the high half of the digits of their depth in it.
template <class ForRecords>
void LineBins::sort(std::size_t count, std::uint32_t first_key, ForRecords&& for_records) {
  const std::size_t from = sorted_.size();
  const std::uint64_t width = depths / static_cast<std::uint64_t>(slabs_) + 1;
  const int digit = std::min(line_key_bits / 2, (static_cast<int>(std::bit_width(width)) + 1) / 2);
  const std::uint32_t low_digit = (1u << digit) - 1;
  std::uint32_t low[1 << line_key_bits / 2], high[1 << line_key_bits / 2], low_sum = 0, high_sum = 0;
  std::fill_n(low, low_digit + 1, 0), std::fill_n(high, low_digit + 1, 0);
  for_records([&](const LineRecord& r) {
    const std::uint32_t key = r.key - first_key;
    ++low[key & low_digit], ++high[key >> digit];
  });
  for (std::uint32_t d = 0; d <= low_digit; ++d) {
    low_sum += std::exchange(low[d], low_sum);
    high_sum += std::exchange(high[d], high_sum);
  }
  if (half_sorted_.size() < count) half_sorted_.resize(count);
  sorted_.resize(from + count);
  LineRecord *half = half_sorted_.data(), *to = sorted_.data() + from;
  for_records([&](const LineRecord& r) { half[low[(r.key - first_key) & low_digit]++] = r; });
  for (std::size_t k = 0; k < count; ++k) to[high[(half[k].key - first_key) >> digit]++] = half[k];
}

const std::vector<LineRecord>& LineBins::sorted(std::int32_t tile) {
  sorted_.clear();
  if (bins_.size() == 1) {
    sort(projected_.size(), 0, [&](auto&& visit) {
      for (const LineRecord& r : projected_) visit(r);
    });
    return sorted_;
  }
  const auto slabs = static_cast<std::uint64_t>(slabs_);
  for (std::uint64_t slab = 0; slab < slabs; ++slab) {
    // the smallest key of the slab: key * slabs >> line_key_bits == slab
    const std::uint64_t first_key = ((slab << line_key_bits) + slabs - 1) / slabs;
    const Bin& bin = bins_[static_cast<std::uint64_t>(tile) * slabs + slab];
    sort(count(bin), static_cast<std::uint32_t>(first_key), [&](auto&& visit) { for_records(bin, visit); });
  }
  return sorted_;
}

}  // namespace granrad
