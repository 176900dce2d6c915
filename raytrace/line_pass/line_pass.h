#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/line_pass/line_bins.h"
#include "raytrace/line_pass/line_images.h"
#include "raytrace/line_pass/line_lattice.h"

namespace granrad {

/// One thread's work on one direction: the lattice, tile by tile, and the discs of each tile by depth. Reused
/// from one direction to the next, so that nothing is allocated in the loop.
class LinePass {
 public:
  explicit LinePass(const LineScene& scene);

  /// Sets up the direction: places the lattice, projects the spheres and sorts them by tile and depth.
  void aim(const LineFrame& frame);

  /// Emits every pair of neighbours on a line, tile by tile: calls `discs(begin, end)` with blocks of the
  /// stream of LineKernels::emit (predecessors are surface numbers), then `walls(surface, ids, count)` for
  /// what the lines saw last before each wall or the surroundings. The order is that of depth, row, column.
  template <class Discs, class Walls>
  void emit(Discs&& discs, Walls&& walls);
  /// The same; `visit(surface, cell, from)` sees the end of every line. Here surfaces of periodic scenes may
  /// be images (see LineImages), predecessors unknown_id; `emit` keeps the line ends in the box.
  template <class Discs, class Visit>
  void emit_ends(Discs&& discs, Visit&& visit);
  /// The same, one by one: visit(surface, cell, from).
  template <class Visit>
  void visit_all_ends(Visit&& visit);
  /// As `emit`, one by one: pair(surface, from).
  template <class Pair>
  void emit_pairs(Pair&& pair);
  /// Not for periodic scenes. Emits how often each pair follows each other: `runs(begin, end)` gets blocks of
  /// the stream of LineKernels::emit_runs, walls and surroundings included.
  template <class Runs>
  void emit_runs(Runs&& runs);

  /// Of a periodic scene: what the line of `cell` met before it came to `surface`, unknown to the images.
  Hit hit_before(std::int32_t surface, std::int64_t cell) const;

  /// Not for periodic scenes. Adds sum (power there - own power) over all line ends of each surface to
  /// `received` [surfaces], both in the order of the scene. Walks the lines forth and back. Powers in (-2^27,
  /// 2^27).
  void receive(const std::vector<std::int32_t>& power, std::int64_t* received);

  /// Lines cut by rounding in a closed enclosure: met by no wall at their end. Since construction.
  std::int64_t leaked() const { return leaked_; }

  /// Sphere or image by its number in the streams.
  LineBall ball(std::int32_t surface) const {
    if (images_) return images_->ball(surface);
    const auto k = static_cast<std::size_t>(place_[static_cast<std::size_t>(surface)]);
    return {{scene_.x[k], scene_.y[k], scene_.z[k]}, scene_.radius[k]};
  }
  /// Images of a periodic scene, else nothing.
  const std::optional<LineImages>& images() const { return images_; }
  const LineScene& scene() const { return scene_; }
  const LineFrame& frame() const { return frame_; }
  const LineLattice& lattice() const { return lattice_; }
  /// Column and row in the whole lattice of a cell of the tile being emitted.
  std::int32_t column(std::int64_t cell) const {
    return static_cast<std::int32_t>(cell % lattice_.pitch) - lattice_.margin + lattice_.first_column(tile_);
  }
  std::int32_t row(std::int64_t cell) const {
    return static_cast<std::int32_t>(cell / lattice_.pitch) - lattice_.margin + lattice_.first_row(tile_);
  }

 private:
  using Draw = decltype(LineKernels::emit);
  using Spans = std::vector<LineSpan>;
  template <class Stream>
  void draw(Draw kernel, Stream&& stream);
  template <class Visit>
  void visit_ends(Visit&& visit);
  template <class Run>
  void visit_own_cells(Run&& run);
  template <class Value>
  void fill(const Spans& entries, std::int32_t outside, Value&& value);
  std::int32_t known(std::int32_t from, std::int32_t surface, std::int64_t cell);
  std::int64_t keep_home(std::int64_t length);
  void receive_one_way(const Spans& from, const Spans& to, bool forth, const std::vector<std::int32_t>& power,
                       std::int64_t* received);

  const LineScene& scene_;
  const LineKernels& kernels_;
  std::optional<LineImages> images_;
  std::vector<std::int32_t> place_;  ///< in the scene, by surface number
  LineSpheres spheres_;
  LineFrame frame_{};
  LineLattice lattice_;
  LineBins bins_;
  const std::vector<LineRecord>* discs_ = nullptr;  ///< of the tile
  std::int32_t tile_ = 0;
  std::vector<std::int32_t> cells_, stream_;
  std::int64_t reserve_;
  std::int64_t leaked_ = 0;
};

template <class Stream>
void LinePass::draw(Draw kernel, Stream&& stream) {
  discs_ = &bins_.sorted(tile_);
  fill(lattice_.entry[static_cast<std::size_t>(tile_)], outside_id,
       [](std::int32_t surface) { return surface; });
  const auto count = static_cast<std::int32_t>(discs_->size());
  for (std::int32_t t = 0; t < count;) {
    std::int64_t length = 0;
    t = kernel(discs_->data(), t, count, spheres_, cells_.data(), lattice_.pitch, stream_.data(),
               static_cast<std::int64_t>(stream_.size()), reserve_, &length);
    stream(stream_.data(), stream_.data() + length);
  }
}

/// Calls run(begin, end) for the cells of each row of the tile that belong to the lattice.
template <class Run>
void LinePass::visit_own_cells(Run&& run) {
  const std::int32_t side = 1 << lattice_.tile_shift, column = lattice_.first_column(tile_),
                     row = lattice_.first_row(tile_);
  const std::int32_t width = std::min(side, lattice_.columns - column);
  for (std::int32_t r = row; r < std::min(row + side, lattice_.rows); ++r) {
    const std::int64_t begin = lattice_.cell(tile_, column, r);
    run(begin, begin + width);
  }
}

/// Gives every cell the value of the surface at which its line enters.
template <class Value>
void LinePass::fill(const Spans& entries, std::int32_t outside, Value&& value) {
  const auto set = [&](std::int64_t begin, std::int64_t end, std::int32_t surface) {
    std::fill(cells_.begin() + begin, cells_.begin() + end, value(surface));
  };
  cells_.assign(lattice_.tile_cells(), outside);
  if (!scene_.closed) {
    const auto before = images_ ? unknown_id : value(scene_.open_surface);
    visit_own_cells([&](std::int64_t begin, std::int64_t end) {
      std::fill(cells_.begin() + begin, cells_.begin() + end, before);
    });
  }
  for (const LineSpan& s : entries) set(s.begin, s.end, s.surface);
}

template <class Visit>
void LinePass::visit_ends(Visit&& visit) {
  const auto visit_run = [&](std::int64_t begin, std::int64_t end, std::int32_t surface) {
    for (std::int64_t c = begin; c < end; ++c) {
      if (cells_[c] != outside_id && cells_[c] != surface) visit(surface, c, cells_[c]);
      leaked_ += scene_.closed && cells_[c] == outside_id;
      cells_[c] = outside_id;
    }
  };
  for (const LineSpan& span : lattice_.exit[static_cast<std::size_t>(tile_)])
    visit_run(span.begin, span.end, span.surface);
  if (images_) return;
  visit_own_cells([&](std::int64_t begin, std::int64_t end) {
    if (!scene_.closed)
      visit_run(begin, end, scene_.open_surface);
    else
      for (std::int64_t c = begin; c < end; ++c) leaked_ += cells_[c] != outside_id;
  });
}

template <class Discs, class Visit>
void LinePass::emit_ends(Discs&& discs, Visit&& visit) {
  for (tile_ = 0; tile_ < lattice_.tiles(); ++tile_) {
    draw(kernels_.emit, discs);
    visit_ends(visit);
  }
}

template <class Discs, class Walls>
void LinePass::emit(Discs&& discs, Walls&& walls) {
  for (tile_ = 0; tile_ < lattice_.tiles(); ++tile_) {
    draw(kernels_.emit, [&](std::int32_t* begin, std::int32_t* end) {
      discs(begin, images_ ? begin + keep_home(end - begin) : end);
    });
    std::int64_t held = 0;
    std::int32_t holder = -1;
    const auto hand_over = [&] {
      if (held > 0) walls(holder, stream_.data(), held);
      held = 0;
    };
    visit_ends([&](std::int32_t surface, std::int64_t cell, std::int32_t from) {
      if (surface != holder || held == reserve_) hand_over();
      holder = surface;
      stream_[held++] = images_ ? known(from, surface, cell) : from;
    });
    hand_over();
  }
}

template <class Visit>
void LinePass::visit_all_ends(Visit&& visit) {
  emit_ends(
      [&](const std::int32_t* p, const std::int32_t* end) {
        while (p < end) {
          const std::int32_t surface = p[0], corner = p[1];
          auto mask = static_cast<unsigned>(p[2]) & 0xffff;
          for (p += 3; mask; mask &= mask - 1, ++p) {
            const int k = __builtin_ctz(mask);
            visit(surface, corner + std::int64_t{k / line_tile} * lattice_.pitch + k % line_tile, *p);
          }
        }
      },
      visit);
}

template <class Pair>
void LinePass::emit_pairs(Pair&& pair) {
  emit(
      [&](const std::int32_t* p, const std::int32_t* end) {
        while (p < end) {
          const std::int32_t surface = p[0], n = p[2] >> 16;
          p += 3;
          for (const std::int32_t* last = p + n; p < last; ++p) pair(surface, *p);
        }
      },
      [&](std::int32_t wall, const std::int32_t* from, std::int64_t n) {
        for (std::int64_t k = 0; k < n; ++k) pair(wall, from[k]);
      });
}

template <class Runs>
void LinePass::emit_runs(Runs&& runs) {
  for (tile_ = 0; tile_ < lattice_.tiles(); ++tile_) {
    draw(kernels_.emit_runs, runs);
    std::int32_t record[3] = {-1, 1, 0}, from = -1, count = 0;
    const auto hand_over = [&] {
      record[2] = from << line_run_bits | (count - 1);
      if (count > 0) runs(record, record + 3);
      count = 0;
    };
    visit_ends([&](std::int32_t surface, std::int64_t, std::int32_t last) {
      if (surface != record[0] || last != from || count == 1 << line_run_bits) hand_over();
      record[0] = surface, from = last, ++count;
    });
    hand_over();
  }
}

}  // namespace granrad
