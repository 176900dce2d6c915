#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace granrad {

/// Lines that a pair of equal spheres sees each other by, and that neighbours may block.
///
/// Two spheres of diameter 1, centres at 0 and s e_z, exchange along all lines that meet both, and all count alike
/// (isotropic, uniform). Directions at an angle theta to the axis come in proportion to sin(theta) Lens(s sin(theta)),
/// Lens the overlap of the two discs that the spheres throw along them; on it points are uniform. 1024 such lines
/// stand for a close pair, down to 64 where it is far and exchanges little: a lattice over angle, turn and point. They are kept for bins
/// of the distance, of 1 / bins_per_diameter up to `near`, beyond in even steps of 1 / s: the cone narrows as 1 / s.
class BeamLines {
 public:
  static constexpr std::size_t most = 1024;
  static constexpr double near = 6;
  static constexpr int bins_per_diameter = 24;

  /// Lines of one distance. Through the plane of the first centre at `point`, which is perpendicular to `direction`; the
  /// second centre, s away, lies beside a line at s direction_z.
  struct Set {
    std::vector<float> point_x, point_y, point_z, direction_x, direction_y, direction_z;

    explicit Set(std::size_t count);  ///< a multiple of 64, at most `most`
    std::size_t count() const { return point_x.size(); }
  };

  BeamLines();
  const Set& at(double distance) const;

 private:
  static constexpr int near_bins = static_cast<int>((near - 1) * bins_per_diameter);
  static constexpr int far_bins = static_cast<int>(near * bins_per_diameter);
  static double distance_of(int bin);
  static std::size_t count_at(double distance);
  std::vector<Set> sets_;
};

/// Which lines of a set are blocked.
class BlockedLines {
 public:
  explicit BlockedLines(std::size_t lines) { std::fill_n(blocked_.begin(), lines, 0); }
  /// Adds a sphere of radius sqrt(radius2) at (x, y, z), in diameters of the pair: it blocks the lines it meets between
  /// the two centres, `distance` apart (for disjoint spheres the order of the hits is that of the centres).
  void add(const BeamLines::Set& lines, float distance, float x, float y, float z, float radius2);
  const std::int32_t* of_lines() const { return blocked_.data(); }  ///< 0 or 1
  std::size_t count() const { return static_cast<std::size_t>(blocked_count_); }

 private:
  std::array<std::int32_t, BeamLines::most> blocked_;
  std::int32_t blocked_count_ = 0;
};

}  // namespace granrad
