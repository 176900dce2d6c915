#include "raytrace/line_pass/line_pass.h"

#include <algorithm>
#include <cmath>

#include "raytrace/line_pass/line_geometry.h"

namespace granrad {

namespace {
constexpr std::int64_t stream_block = 16384;  // integers: 64 KiB, stays in the second-level cache
}

LinePass::LinePass(const LineScene& scene)
    : scene_(scene), kernels_(line_kernels()), spheres_(scene.spheres()) {
  if (scene.is_periodic()) images_.emplace(scene);
  place_.resize(scene.surface.size());
  for (std::size_t k = 0; k < place_.size(); ++k)
    place_[static_cast<std::size_t>(scene.surface[k])] = static_cast<std::int32_t>(k);
  const auto tiles_across = static_cast<std::int64_t>(2 * spheres_.max_reach) / line_tile + 1;
  reserve_ = std::max(stream_block, tiles_across * tiles_across * (3 + line_tile * line_tile) + 16);
  stream_.resize(static_cast<std::size_t>(2 * reserve_));
}

void LinePass::aim(const LineFrame& frame) {
  frame_ = frame;
  lattice_.place(scene_, frame);
  if (images_) spheres_ = images_->choose(frame_, lattice_);
  bins_.fill(kernels_, spheres_, lattice_, lattice_.projection(scene_, frame));
}

Hit LinePass::hit_before(std::int32_t surface, std::int64_t cell) const {
  const double depth = LineGeometry{*this}.depth(surface, cell, -1);
  return scene_.tracer->first_hit(LineGeometry{*this}.point(cell, depth) + scene_.middle, -1.0 * frame_.w,
                                  surface);
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
  for (tile_ = 0; tile_ < lattice_.tiles(); ++tile_) {
    discs_ = &bins_.sorted(tile_);
    const Spans &entry = lattice_.entry[static_cast<std::size_t>(tile_)],
                &exit = lattice_.exit[static_cast<std::size_t>(tile_)];
    receive_one_way(entry, exit, true, power, received);
    receive_one_way(exit, entry, false, power, received);
  }
}

void LinePass::receive_one_way(const Spans& from, const Spans& to, bool forth,
                               const std::vector<std::int32_t>& power, std::int64_t* received) {
  fill(from, outside_power, [&](std::int32_t surface) { return power[surface]; });
  const auto count = static_cast<std::int32_t>(discs_->size());
  if (count > 0)
    kernels_.receive(forth ? discs_->data() : discs_->data() + count - 1, count, forth ? 1 : -1, spheres_,
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
  if (!scene_.closed)
    visit_own_cells([&](std::int64_t begin, std::int64_t end) { arrive(begin, end, scene_.open_surface); });
}

}  // namespace granrad
