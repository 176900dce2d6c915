#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/embree_tracer.h"
#include "raytrace/line_images.h"
#include "raytrace/line_lattice.h"

namespace granrad {

/// One thread's work on one direction: the lattice, the discs sorted by depth, and the cells. Reused from one
/// direction to the next, so that nothing is allocated in the loop.
class LinePass {
 public:
  explicit LinePass(const LineScene& scene);

  /// Sets up the direction: places the lattice, projects the spheres and sorts them by depth.
  void aim(const LineFrame& frame);

  /// Emits every pair of neighbours on a line: calls `discs(begin, end)` with blocks of the stream of
  /// LineKernels::emit (spheres and predecessors are surface numbers; of periodic scenes the line ends in the
  /// box), then `walls(surface, ids, count)` for what the
  /// lines saw last before each wall or the surroundings. The order is that of depth, row and column.
  template <class Discs, class Walls>
  void emit(Discs&& discs, Walls&& walls);
  /// The two halves of it; `visit(surface, cell, from)` sees the end of every line. In periodic scenes discs
  /// and predecessors may be images (see LineImages) or unknown_id.
  template <class Discs>
  void emit_discs(Discs&& discs);
  template <class Visit>
  void visit_ends(Visit&& visit);

  /// Of a periodic scene: what the line of `cell` met before it came to `surface`, unknown to the images.
  Hit hit_before(std::int32_t surface, std::int64_t cell) const;

  /// Not for periodic scenes. Adds sum (power there - own power) over all line ends of each surface to
  /// `received` [surfaces]. Walks the lines forth and back. Powers in (-2^27, 2^27).
  void receive(const std::vector<std::int32_t>& power, std::int64_t* received);

  /// Lines cut by rounding in a closed enclosure: met by no wall at their end. Since construction.
  std::int64_t leaked() const { return leaked_; }

  /// Images of a periodic scene, else nothing.
  const std::optional<LineImages>& images() const { return images_; }
  const LineScene& scene() const { return scene_; }
  const LineFrame& frame() const { return frame_; }
  const LineLattice& lattice() const { return lattice_; }
  const std::vector<LineRecord>& records() const { return record_; }

 private:
  void sort_by_depth();
  void fill_entries(const std::vector<LineSpan>& spans, std::int32_t outside, std::int32_t open);
  std::int32_t draw(std::int32_t begin, std::int64_t& length);
  std::int32_t known(std::int32_t from, std::int32_t surface, std::int64_t cell);
  std::int64_t keep_home(std::int64_t length);
  void receive_one_way(const std::vector<LineSpan>& from, const std::vector<LineSpan>& to, bool forth,
                       const std::vector<std::int32_t>& power, std::int64_t* received);

  const LineScene& scene_;
  const LineKernels& kernels_;
  std::optional<LineImages> images_;
  LineSpheres spheres_;
  LineFrame frame_{};
  LineLattice lattice_;
  std::vector<std::uint32_t> key_, key_scratch_;
  std::vector<LineRecord> record_, record_scratch_;
  std::vector<std::int32_t> cells_, stream_;
  std::int64_t reserve_;
  std::int64_t leaked_ = 0;
};

template <class Discs>
void LinePass::emit_discs(Discs&& discs) {
  fill_entries(lattice_.entry, outside_id, scene_.open_surface);
  const auto count = static_cast<std::int32_t>(record_.size());
  for (std::int32_t t = 0; t < count;) {
    std::int64_t length = 0;
    t = draw(t, length);
    discs(stream_.data(), stream_.data() + length);
  }
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
  for (const LineSpan& span : lattice_.exit) visit_run(span.begin, span.end, span.surface);
  const auto end = static_cast<std::int64_t>(lattice_.cell_count());
  if (scene_.is_periodic()) return;
  if (!scene_.closed)
    visit_run(0, end, scene_.open_surface);
  else
    for (std::int64_t c = 0; c < end; ++c) leaked_ += cells_[c] != outside_id;
}

template <class Discs, class Walls>
void LinePass::emit(Discs&& discs, Walls&& walls) {
  emit_discs([&](std::int32_t* begin, std::int32_t* end) {
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

}  // namespace granrad
