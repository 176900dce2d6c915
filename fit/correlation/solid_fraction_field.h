#pragma once
#include <array>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// Solid fraction of an enclosure as a whole: what make_enclosure measured in its region, else the volume of
/// the spheres over that enclosed by the walls. Throws InputError when neither is known.
double solid_fraction(const Enclosure& enclosure);

/// Solid fraction around each place of an enclosure: of what shades a pair, or a sphere from a wall.
///
/// Spheres are shared out to cells of about one diameter (as cubes of equal volume) and averaged over windows
/// that would hold 100 spheres, at least 5 d wide, less where walls cut them. In a uniform bed that mean
/// fluctuates by less than 12 % of itself (hard-sphere fluids at 0.02 to 0.5 in the 12.5 x 5 d channel); such
/// beds count as uniform and take the solid fraction of the whole, as the tables were fitted.
/// Where the rms deviation over the spheres passes 15 % the local values take over, completely at 30 %.
/// Enclosures that are not convex count as uniform.
class SolidFractionField {
 public:
  SolidFractionField(const Enclosure& enclosure, double whole);
  /// Of a bed taken as uniform.
  explicit SolidFractionField(double whole) : whole_(whole), mean_(whole), largest_(whole) {}

  bool uniform() const { return local_share_ == 0; }
  double whole() const { return whole_; }
  /// Rms over the spheres of (window - whole) / whole.
  double deviation() const { return deviation_; }
  /// Mean and largest value over the spheres.
  double mean_at_spheres() const { return mean_; }
  double largest() const { return largest_; }
  double at(const Vec3& place_m) const { return uniform() ? whole_ : value_[cell_of(place_m)]; }
  /// Mean along the line between two places.
  double between(const Vec3& from_m, const Vec3& to_m) const;

 private:
  std::size_t cell_of(const Vec3& place_m) const;
  void choose_cells(double edge_m);
  void share_out(const Enclosure& enclosure, std::vector<double>& solid) const;
  std::vector<double> free_parts(const Enclosure& enclosure) const;
  void average(const std::vector<double>& solid, const std::vector<double>& space, double width_m);
  void measure(const Enclosure& enclosure);

  double whole_, deviation_ = 0, local_share_ = 0, mean_, largest_;
  Box box_;
  std::array<int, 3> count_{1, 1, 1};
  Vec3 cell_m_;
  std::vector<double> value_;  ///< by cell
};

}  // namespace granrad
