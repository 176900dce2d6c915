#include "raytrace/shading/beam_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"

namespace granrad {

namespace {

/// Overlap of two discs of diameter 1 whose centres are `offset` apart.
double lens_area(double offset) {
  if (offset >= 1) return 0;
  return 0.5 * std::acos(offset) - 0.5 * offset * std::sqrt(1 - offset * offset);
}

/// Part of a disc of diameter 1 beyond a chord at distance c from its centre.
double segment_area(double c) {
  return 0.25 * std::acos(2 * c) - c * std::sqrt(std::max(0.0, 0.25 - c * c));
}

/// Angles at equal steps of the cumulated distribution sin(theta) Lens(s sin(theta)).
class AngleTable {
 public:
  explicit AngleTable(double s) : largest_(std::asin(std::min(1.0, 1 / s))), cumulated_(steps + 1, 0) {
    for (int k = 0; k < steps; ++k) {
      const double sine = std::sin((k + 0.5) / steps * largest_);
      cumulated_[k + 1] = cumulated_[k] + sine * lens_area(s * sine);
    }
  }
  double angle(double u) const {
    const double wanted = u * cumulated_.back();
    const auto above = std::upper_bound(cumulated_.begin() + 1, cumulated_.end() - 1, wanted);
    const auto k = above - cumulated_.begin() - 1;
    const double part = (wanted - cumulated_[k]) / (cumulated_[k + 1] - cumulated_[k]);
    return (static_cast<double>(k) + part) / steps * largest_;
  }

 private:
  static constexpr int steps = 2000;
  double largest_;
  std::vector<double> cumulated_;
};

/// Place across the lens of discs at 0 and `offset`, from one uniform: the area below it is u of the lens.
double place_across(double offset, double u) {
  const double half = offset / 2, side = u < 0.5 ? -1 : 1;
  const double beyond = segment_area(half) * (1 - std::abs(2 * u - 1));
  double low = half, high = 0.5;
  for (int k = 0; k < 26; ++k) {  // single precision
    const double middle = 0.5 * (low + high);
    (segment_area(middle) > beyond ? low : high) = middle;
  }
  return half + side * (low - half);
}

}  // namespace

BeamLines::BeamLines() {
  // multiples of the powers of 1/x, x^5 = x + 1: an even lattice in four dimensions
  constexpr double step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378086, 0.53859725722361};
  for (int bin = 0; bin < near_bins + far_bins; ++bin) {
    const double s = distance_of(bin);
    const AngleTable angles(s);
    Set& set = sets_.emplace_back(count_at(s));
    const auto count = static_cast<double>(set.count());
    for (std::size_t k = 0; k < set.count(); ++k) {
      double u[4];
      for (int d = 0; d < 4; ++d) u[d] = std::fmod(0.5 / count + static_cast<double>(k) * step[d], 1.0);
      const double theta = angles.angle((static_cast<double>(k) + 0.5) / count), turn = 2 * pi * u[1];
      const double sine = std::sin(theta), cosine = std::cos(theta), offset = s * sine;
      const double x = place_across(std::min(offset, 1.0), u[2]);
      const double centre =
          x > offset / 2 ? x : offset - x;  // distance from the centre of the disc that bounds it
      const double y = (2 * u[3] - 1) * std::sqrt(std::max(0.0, 0.25 - centre * centre));
      const double c = std::cos(turn), n = std::sin(turn);
      set.direction_x[k] = static_cast<float>(sine * c);
      set.direction_y[k] = static_cast<float>(sine * n);
      set.direction_z[k] = static_cast<float>(cosine);
      // across: towards the other disc (-cosine c, -cosine n, sine), and (-n, c, 0)
      set.point_x[k] = static_cast<float>(-x * cosine * c - y * n);
      set.point_y[k] = static_cast<float>(-x * cosine * n + y * c);
      set.point_z[k] = static_cast<float>(x * sine);
    }
  }
}

/// A pair's factor falls as 1 / s^2, and with it what the evenness of its lines matters.
std::size_t BeamLines::count_at(double distance) {
  return distance < 2 ? most : distance < 3 ? 512 : distance < 5 ? 256 : distance < 8 ? 128 : 64;
}

BeamLines::Set::Set(std::size_t count)
    : point_x(count),
      point_y(count),
      point_z(count),
      direction_x(count),
      direction_y(count),
      direction_z(count) {}

/// The middle of a bin.
double BeamLines::distance_of(int bin) {
  if (bin < near_bins) return 1 + (bin + 0.5) / bins_per_diameter;
  return near / (1 - (bin - near_bins + 0.5) / far_bins);
}

const BeamLines::Set& BeamLines::at(double distance) const {
  const int bin = distance < near ? static_cast<int>((distance - 1) * bins_per_diameter)
                                  : near_bins + static_cast<int>((1 - near / distance) * far_bins);
  return sets_[static_cast<std::size_t>(std::clamp(bin, 0, near_bins + far_bins - 1))];
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void BlockedLines::add(const BeamLines::Set& lines, float distance, float x, float y, float z, float radius2) {
  const std::size_t count = lines.count();
  const float *px = lines.point_x.data(), *py = lines.point_y.data(), *pz = lines.point_z.data(),
              *dir_x = lines.direction_x.data(), *dir_y = lines.direction_y.data(),
              *dir_z = lines.direction_z.data();
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float along = x * dir_x[k] + y * dir_y[k] + z * dir_z[k];
    const float dx = x - px[k], dy = y - py[k], dz = z - pz[k];
    const float across2 = dx * dx + dy * dy + dz * dz - along * along;
    const bool hit = (across2 < radius2) & (along > 0) & (along < distance * dir_z[k]);
    blocked_[k] |= static_cast<std::int32_t>(hit);
    sum += blocked_[k];
  }
  blocked_count_ = sum;
}

}  // namespace granrad
