#include "raytrace/line_chords.h"

#include <algorithm>
#include <cmath>

#include "dem/scene/constants.h"

namespace granrad {

namespace {

constexpr double enough_gaps = 1 << 20;

/// Positions along w at which the line of a cell meets surfaces, in metres.
class LineGeometry {
 public:
  explicit LineGeometry(const LinePass& pass) : pass_(pass), place_(pass.scene().surface.size()) {
    for (std::size_t k = 0; k < place_.size(); ++k)
      place_[static_cast<std::size_t>(pass.scene().surface[k])] = static_cast<std::int32_t>(k);
  }

  /// Where the line leaves (side 1) or enters (side -1) a sphere.
  double sphere(std::int32_t surface, std::int64_t cell, int side) const {
    const LineScene& s = pass_.scene();
    const auto i = static_cast<std::size_t>(place_[static_cast<std::size_t>(surface)]);
    const Vec3 c{s.x[i], s.y[i], s.z[i]};
    const LineFrame& f = pass_.frame();
    const double du = u(cell) - dot(c, f.u), dv = v(cell) - dot(c, f.v);
    return dot(c, f.w) + side * std::sqrt(std::max(0.0, s.radius[i] * s.radius[i] - du * du - dv * dv));
  }
  double face(std::int32_t surface, std::int64_t cell) const {
    const LineScene& s = pass_.scene();
    const LineScene::Face& face = s.faces[surface - s.x.size()];
    const LineFrame& f = pass_.frame();
    const Vec3 on_line = u(cell) * f.u + v(cell) * f.v;
    return dot(face.corners[0] - on_line, face.normal) / dot(f.w, face.normal);
  }
  /// Of a sphere or a wall.
  double depth(std::int32_t surface, std::int64_t cell, int side) const {
    return is_sphere(surface) ? sphere(surface, cell, side) : face(surface, cell);
  }
  bool is_sphere(std::int32_t surface) const {
    return static_cast<std::size_t>(surface) < pass_.scene().x.size();
  }
  bool is_open(std::int32_t surface) const { return surface == pass_.scene().open_surface; }

 private:
  double u(std::int64_t cell) const {
    return (pass_.column(cell) + pass_.lattice().origin_u) * pass_.scene().spacing;
  }
  double v(std::int64_t cell) const {
    return (pass_.row(cell) + pass_.lattice().origin_v) * pass_.scene().spacing;
  }
  const LinePass& pass_;
  std::vector<std::int32_t> place_;  ///< of each sphere in the scene
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
  const LineGeometry geometry(pass);
  const LineScene& scene = pass.scene();
  double gaps = 0;
  for (const float reach : scene.reach) gaps += pi * reach * reach;
  const int stride = std::max(1, static_cast<int>(gaps / enough_gaps));
  const int first = static_cast<int>(pass.frame().shift_u * stride);
  ChordSums sums;
  const auto gap = [&](std::int32_t from, std::int32_t to, std::int64_t cell) {
    if (pass.row(cell) % stride != first || geometry.is_open(from) || geometry.is_open(to)) return;
    const double start = geometry.depth(from, cell, 1), end = geometry.depth(to, cell, -1);
    sums.length_m += stride * std::max(0.0, end - start);
    sums.gaps += stride;
  };
  pass.emit_ends(
      [&](const std::int32_t* p, const std::int32_t* end) {
        while (p < end) {
          const std::int32_t surface = p[0], corner = p[1];
          auto mask = static_cast<unsigned>(p[2]) & 0xffff;
          for (p += 3; mask; mask &= mask - 1, ++p) {
            const int k = __builtin_ctz(mask);
            gap(*p, surface, corner + k / line_tile * pass.lattice().pitch + k % line_tile);
          }
        }
      },
      [&](std::int32_t surface, std::int64_t cell, std::int32_t from) { gap(from, surface, cell); });
  return sums;
}

}  // namespace granrad
