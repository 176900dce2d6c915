#include "raytrace/lines/line_chords.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "raytrace/line_pass/line_geometry.h"

namespace granrad {

namespace {

constexpr double enough_gaps = 1 << 20;

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
  const LineGeometry geometry{pass};
  const LineScene& scene = pass.scene();
  double gaps = 0;
  for (const float reach : scene.reach) gaps += pi * reach * reach;
  const int stride = std::max(1, static_cast<int>(gaps / enough_gaps));
  const int first = static_cast<int>(pass.frame().shift_u * stride);
  ChordSums sums;
  const auto gap = [&](std::int32_t from, std::int32_t to, std::int64_t cell) {
    if (pass.row(cell) % stride != first || from == scene.open_surface || to == scene.open_surface) return;
    if (pass.images() && pass.images()->is_image(to)) return;
    const double length = from == unknown_id ? pass.hit_before(to, cell).distance_m
                                             : geometry.depth(to, cell, -1) - geometry.depth(from, cell, 1);
    if (!std::isfinite(length)) return;
    sums.length_m += stride * std::max(0.0, length);
    sums.gaps += stride;
  };
  pass.visit_all_ends(
      [&](std::int32_t surface, std::int64_t cell, std::int32_t from) { gap(from, surface, cell); });
  return sums;
}

}  // namespace granrad
