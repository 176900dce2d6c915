#include "raytrace/line_pass.h"

#include <algorithm>
#include <cmath>

namespace granrad {

namespace {
constexpr std::int64_t stream_block = 16384;  // integers: 64 KiB, stays in the second-level cache
}

LinePass::LinePass(const LineScene& scene)
    : scene_(scene), kernels_(line_kernels()), spheres_(scene.spheres()) {
  const auto tiles_across = static_cast<std::int64_t>(2 * spheres_.max_reach) / line_tile + 1;
  reserve_ = std::max(stream_block, tiles_across * tiles_across * (3 + line_tile * line_tile) + 16);
  stream_.resize(static_cast<std::size_t>(2 * reserve_));
}

void LinePass::aim(const LineFrame& frame) {
  frame_ = frame;
  lattice_.place(scene_, frame);
  bins_.fill(kernels_, spheres_, lattice_, lattice_.projection(scene_, frame));
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
