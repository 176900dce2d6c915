#include "raytrace/line_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace granrad {

namespace {
constexpr std::int64_t stream_block = 16384;  // integers: 64 KiB, stays in the second-level cache
}

LinePass::LinePass(const LineScene& scene)
    : scene_(scene), kernels_(line_kernels()), spheres_(scene.spheres()) {
  const std::size_t n = scene.x.size();
  key_.resize(n), key_scratch_.resize(n);
  record_.resize(n), record_scratch_.resize(n);
  const auto tiles_across = static_cast<std::int64_t>(2 * spheres_.max_reach) / line_tile + 1;
  reserve_ = std::max(stream_block, tiles_across * tiles_across * (3 + line_tile * line_tile) + 16);
  stream_.resize(static_cast<std::size_t>(2 * reserve_));
}

void LinePass::aim(const LineFrame& frame) {
  frame_ = frame;
  lattice_.place(scene_, frame);
  kernels_.project(spheres_, lattice_.projection(scene_, frame), key_.data(), record_.data());
  sort_by_depth();
}

void LinePass::sort_by_depth() {
  constexpr int bits = line_key_bits / 2, buckets = 1 << bits, low_bits = buckets - 1;
  std::uint32_t low[buckets] = {}, high[buckets] = {};
  const std::size_t n = record_.size();
  for (std::size_t i = 0; i < n; ++i) ++low[key_[i] & low_bits], ++high[key_[i] >> bits];
  std::uint32_t low_sum = 0, high_sum = 0;
  for (int b = 0; b < buckets; ++b) {
    low_sum += std::exchange(low[b], low_sum);
    high_sum += std::exchange(high[b], high_sum);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t to = low[key_[i] & low_bits]++;
    key_scratch_[to] = key_[i] >> bits;
    record_scratch_[to] = record_[i];
  }
  for (std::size_t i = 0; i < n; ++i) record_[high[key_scratch_[i]]++] = record_scratch_[i];
}

void LinePass::fill_entries(const std::vector<LineSpan>& spans, std::int32_t outside, std::int32_t open) {
  cells_.assign(lattice_.cell_count(), scene_.closed ? outside : open);
  for (const LineSpan& s : spans) std::fill(cells_.begin() + s.begin, cells_.begin() + s.end, s.surface);
}

std::int32_t LinePass::draw(std::int32_t begin, std::int64_t& length) {
  return kernels_.emit(record_.data(), begin, static_cast<std::int32_t>(record_.size()), spheres_,
                       cells_.data(), lattice_.pitch, stream_.data(),
                       static_cast<std::int64_t>(stream_.size()), reserve_, &length);
}

void LinePass::receive(const std::vector<std::int32_t>& power, std::int64_t* received) {
  receive_one_way(lattice_.entry, lattice_.exit, true, power, received);
  receive_one_way(lattice_.exit, lattice_.entry, false, power, received);
}

void LinePass::receive_one_way(const std::vector<LineSpan>& from, const std::vector<LineSpan>& to, bool forth,
                               const std::vector<std::int32_t>& power, std::int64_t* received) {
  const std::int32_t open_power = power[scene_.open_surface];
  cells_.assign(lattice_.cell_count(), scene_.closed ? outside_power : open_power);
  for (const LineSpan& s : from)
    std::fill(cells_.begin() + s.begin, cells_.begin() + s.end, power[s.surface]);
  const auto count = static_cast<std::int32_t>(record_.size());
  if (count > 0)
    kernels_.receive(forth ? record_.data() : record_.data() + count - 1, count, forth ? 1 : -1, spheres_,
                     power.data(), cells_.data(), lattice_.pitch, received);
  const auto arrive = [&](std::int64_t begin, std::int64_t end, std::int32_t surface) {
    std::int64_t sum = 0;
    for (std::int64_t c = begin; c < end; ++c)
      sum += cells_[c] == outside_power ? 0 : std::int64_t{cells_[c]} - power[surface];
    received[surface] += sum;
  };
  for (const LineSpan& s : to) {
    arrive(s.begin, s.end, s.surface);
    if (!scene_.closed) std::fill(cells_.begin() + s.begin, cells_.begin() + s.end, outside_power);
  }
  if (!scene_.closed) arrive(0, static_cast<std::int64_t>(cells_.size()), scene_.open_surface);
}

}  // namespace granrad
