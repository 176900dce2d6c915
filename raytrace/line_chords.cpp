#include "raytrace/line_chords.h"

#include <cmath>

#include "raytrace/line_geometry.h"

namespace granrad {

namespace {

/// Where the gap behind `from` begins on the line of a cell, m along w.
class Starts {
 public:
  explicit Starts(const LinePass& pass)
      : pass_(pass), scene_(pass.scene()), geometry_{scene_, pass.frame(), pass.lattice()} {}

  double sphere(std::int32_t id, std::int64_t cell, int side) const {
    const auto& images = pass_.images();
    const auto home = images ? images->home(id) : id;
    const Vec3 centre = images ? images->centre(id) : Vec3{scene_.x[id], scene_.y[id], scene_.z[id]};
    return geometry_.sphere(centre, scene_.radius[home], cell, side);
  }
  double face(std::int32_t surface, std::int64_t cell) const {
    return geometry_.face(scene_.faces[surface - scene_.x.size()], cell);
  }
  double of(std::int32_t from, std::int64_t cell) const {
    const bool wall = from >= static_cast<std::int32_t>(scene_.x.size()) && from < scene_.open_surface;
    return wall ? face(from, cell) : sphere(from, cell, 1);
  }

 private:
  const LinePass& pass_;
  const LineScene& scene_;
  LineGeometry geometry_;
};

/// Relative standard deviation.
template <class Value>
double relative_scatter(const std::vector<ChordSums>& samples, Value value) {
  const double n = static_cast<double>(samples.size());
  double mean = 0, squares = 0;
  for (const auto& s : samples) mean += value(s) / n;
  for (const auto& s : samples) squares += (value(s) - mean) * (value(s) - mean);
  return n > 1 && mean > 0 ? std::sqrt(squares / (n - 1)) / mean : 1;
}

}  // namespace

MeanChord mean_chord(const std::vector<ChordSums>& samples, double total_gaps, double swept) {
  if (samples.empty() || total_gaps <= 0) return {};
  const double n = static_cast<double>(samples.size());
  double length = 0;
  for (const auto& s : samples) length += s.length_m / n;
  const double lengths = relative_scatter(samples, [](const ChordSums& s) { return s.length_m; });
  const double gaps =
      relative_scatter(samples, [](const ChordSums& s) { return static_cast<double>(s.gaps); });
  const double value = length / (total_gaps / swept);
  return {value, value * std::sqrt(lengths * lengths / n + gaps * gaps / swept)};
}

ChordSums chord_sums(LinePass& pass) {
  const Starts starts(pass);
  const std::int32_t pitch = pass.lattice().pitch, open = pass.scene().open_surface;
  ChordSums sums;
  const auto gap = [&](std::int32_t surface, std::int32_t from, double to_depth, std::int64_t cell) {
    if (from == open) return;
    const double length =
        from == unknown_id ? pass.hit_before(surface, cell).distance_m : to_depth - starts.of(from, cell);
    if (!std::isfinite(length)) return;
    sums.length_m += std::max(0.0, length);
    ++sums.gaps;
  };
  pass.emit_discs([&](const std::int32_t* p, const std::int32_t* end) {
    while (p < end) {
      const std::int32_t sphere = p[0], corner = p[1];
      auto mask = static_cast<unsigned>(p[2]) & 0xffff;
      if (pass.images() && pass.images()->is_image(sphere)) {
        p += 3 + (p[2] >> 16);
        continue;
      }
      for (p += 3; mask; mask &= mask - 1, ++p) {
        const int k = __builtin_ctz(mask);
        const std::int64_t cell = corner + static_cast<std::int64_t>(k / line_tile) * pitch + k % line_tile;
        gap(sphere, *p, starts.sphere(sphere, cell, -1), cell);
      }
    }
  });
  pass.visit_ends([&](std::int32_t surface, std::int64_t cell, std::int32_t from) {
    if (surface != open) gap(surface, from, starts.face(surface, cell), cell);
  });
  return sums;
}

}  // namespace granrad
