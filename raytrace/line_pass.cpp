#include "raytrace/line_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytrace/line_geometry.h"

namespace granrad {

namespace {
constexpr std::int64_t stream_block = 16384;  // integers: 64 KiB, stays in the second-level cache
}

LinePass::LinePass(const LineScene& scene)
    : scene_(scene), kernels_(line_kernels()), spheres_(scene.spheres()) {
  if (scene.is_periodic()) images_.emplace(scene);
  const auto tiles_across = static_cast<std::int64_t>(2 * spheres_.max_reach) / line_tile + 1;
  reserve_ = std::max(stream_block, tiles_across * tiles_across * (3 + line_tile * line_tile) + 16);
  stream_.resize(static_cast<std::size_t>(2 * reserve_));
}

void LinePass::aim(const LineFrame& frame) {
  frame_ = frame;
  lattice_.place(scene_, frame);
  if (images_) spheres_ = images_->choose(frame_, lattice_);
  const auto n = static_cast<std::size_t>(spheres_.count);
  key_.resize(n), key_scratch_.resize(n);
  record_.resize(n), record_scratch_.resize(n);
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
  cells_.assign(lattice_.cell_count(), images_ ? unknown_id : scene_.closed ? outside : open);
  for (const LineSpan& s : spans) std::fill(cells_.begin() + s.begin, cells_.begin() + s.end, s.surface);
}

std::int32_t LinePass::draw(std::int32_t begin, std::int64_t& length) {
  return kernels_.emit(record_.data(), begin, static_cast<std::int32_t>(record_.size()), spheres_,
                       cells_.data(), lattice_.pitch, stream_.data(),
                       static_cast<std::int64_t>(stream_.size()), reserve_, &length);
}

Hit LinePass::hit_before(std::int32_t surface, std::int64_t cell) const {
  const LineGeometry geometry{scene_, frame_, lattice_};
  const auto spheres = static_cast<std::int32_t>(scene_.x.size());
  const double depth = surface < spheres
                           ? geometry.sphere(images_->centre(surface), scene_.radius[surface], cell, -1)
                           : geometry.face(scene_.faces[surface - spheres], cell);
  return scene_.tracer->first_hit(geometry.point(cell, depth) + scene_.middle, -1.0 * frame_.w, surface);
}

/// Surface number of what came before `surface`.
std::int32_t LinePass::known(std::int32_t from, std::int32_t surface, std::int64_t cell) {
  if (from != unknown_id) return images_->home(from);
  const Hit hit = hit_before(surface, cell);
  if (hit.surface >= 0 && hit.surface != scene_.open_surface) return hit.surface;
  ++leaked_;
  return scene_.open_surface;
}

/// Drops the line ends on images from the stream and names predecessors by surface; returns what is left.
std::int64_t LinePass::keep_home(std::int64_t length) {
  std::int32_t *to = stream_.data(), *from = to;
  const std::int32_t* end = to + length;
  while (from < end) {
    const std::int32_t sphere = from[0], corner = from[1], bits = from[2], n = bits >> 16;
    if (images_->is_image(sphere)) {
      from += 3 + n;
      continue;
    }
    to[0] = sphere, to[1] = corner, to[2] = bits;
    to += 3, from += 3;
    auto mask = static_cast<unsigned>(bits) & 0xffff;
    for (; mask; mask &= mask - 1) {
      const int k = __builtin_ctz(mask);
      *to++ = known(*from++, sphere, corner + std::int64_t{k / line_tile} * lattice_.pitch + k % line_tile);
    }
  }
  return to - stream_.data();
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
