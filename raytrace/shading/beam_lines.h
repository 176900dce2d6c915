#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace granrad {

/// Lines that a pair of equal spheres sees each other by, and that neighbours may block.
///
/// Two spheres of diameter 1, centres at 0 and s e_z, exchange along all lines that meet both, and all count alike
/// (isotropic, uniform). Directions at an angle theta to the axis come in proportion to sin(theta) Lens(s sin(theta)),
/// Lens the overlap of the two discs that the spheres throw along them; on it points are uniform. 256 such lines stand
/// for the pair: a lattice over angle, turn and point. They are kept for distances in bins of 1 / bins_per_diameter.
class BeamLines {
 public:
  static constexpr std::size_t count = 256;
  static constexpr double longest = 6;  ///< distance of centres in diameters up to which pairs are kept
  static constexpr int bins_per_diameter = 12;

  /// Lines of one distance. Through the plane of the first centre at `point`, which is perpendicular to `direction`;
  /// `end`: where along a line the second centre lies beside it.
  struct Set {
    std::array<float, count> point_x, point_y, point_z, direction_x, direction_y, direction_z, end;
  };

  BeamLines();
  const Set& at(double distance) const;

 private:
  std::vector<Set> sets_;
};

/// Which lines of a set are blocked.
struct BlockedLines {
  std::array<float, BeamLines::count> blocked{};  ///< 0 or 1
  /// Adds a sphere of radius sqrt(radius2) at (x, y, z), in diameters of the pair: it blocks the lines it meets between
  /// the two centres (for disjoint spheres the order of the hits is that of the centres).
  void add(const BeamLines::Set& lines, float x, float y, float z, float radius2);
  double open_share() const;
};

}  // namespace granrad
