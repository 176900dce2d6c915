#include "raytrace/line_chords.h"

#include <cmath>

namespace granrad {

namespace {

/// Positions along w at which the line of a cell meets surfaces, in metres.
class LineGeometry {
 public:
  explicit LineGeometry(const LinePass& pass) : pass_(pass) {}

  /// Where the line leaves (side 1) or enters (side -1) a sphere.
  double sphere(std::int32_t i, std::int64_t cell, int side) const {
    const LineScene& s = pass_.scene();
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
  bool is_sphere(std::int32_t surface) const {
    return static_cast<std::size_t>(surface) < pass_.scene().x.size();
  }
  bool is_open(std::int32_t surface) const { return surface == pass_.scene().open_surface; }

 private:
  double u(std::int64_t cell) const {
    const LineLattice& l = pass_.lattice();
    return (static_cast<double>(cell % l.pitch) + l.origin_u) * pass_.scene().spacing;
  }
  double v(std::int64_t cell) const {
    const LineLattice& l = pass_.lattice();
    return (static_cast<double>(cell / l.pitch) + l.origin_v) * pass_.scene().spacing;
  }
  const LinePass& pass_;
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
  const std::int32_t pitch = pass.lattice().pitch;
  ChordSums sums;
  const auto gap = [&](std::int32_t from, double to_depth, std::int64_t cell) {
    if (geometry.is_open(from)) return;
    const double start =
        geometry.is_sphere(from) ? geometry.sphere(from, cell, 1) : geometry.face(from, cell);
    sums.length_m += std::max(0.0, to_depth - start);
    ++sums.gaps;
  };
  pass.emit_discs([&](const std::int32_t* p, const std::int32_t* end) {
    while (p < end) {
      const std::int32_t sphere = p[0], corner = p[1];
      auto mask = static_cast<unsigned>(p[2]) & 0xffff;
      for (p += 3; mask; mask &= mask - 1, ++p) {
        const int k = __builtin_ctz(mask);
        const std::int64_t cell = corner + static_cast<std::int64_t>(k / line_tile) * pitch + k % line_tile;
        gap(*p, geometry.sphere(sphere, cell, -1), cell);
      }
    }
  });
  pass.visit_ends([&](std::int32_t surface, std::int64_t cell, std::int32_t from) {
    if (!geometry.is_open(surface)) gap(from, geometry.face(surface, cell), cell);
  });
  return sums;
}

}  // namespace granrad
