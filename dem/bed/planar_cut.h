#pragma once
#include <functional>
#include <vector>

#include "dem/base/vec3.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

/// What of a convex polygon lies outside a convex face of the same plane: convex polygons that do not overlap.
/// `normal`: of the polygon; the face may be turned. Places closer than `slack_m` are one; what is thinner
/// than `thin_m` is nothing. The polygon itself, untouched, where the two have nothing in common.
std::vector<std::vector<Vec3>> difference(const std::vector<Vec3>& polygon, const WallFace& face,
                                          const Vec3& normal, double slack_m, double thin_m);

/// What of a convex polygon lies at non-negative height over the plane dot(normal, p) = offset (Sutherland-Hodgman).
std::vector<Vec3> part_above(const std::vector<Vec3>& polygon, const Vec3& normal, double offset);

/// Corners, each once.
class CornerSet {
 public:
  explicit CornerSet(double slack_m) : slack_m_(slack_m) {}

  /// Adds p unless there is one within the slack; returns the one that stands for it.
  Vec3 add(const Vec3& p);
  /// Adds p, which none of the others is near.
  void keep(const Vec3& p) { corners_.push_back(p); }
  /// To be called before the first insert_into.
  void sort();
  /// Inserts the corners that lie inside an edge of the polygon (those that are wanted); whether there were
  /// any.
  bool insert_into(std::vector<Vec3>& polygon, const std::function<bool(const Vec3&)>& wanted = {}) const;

 private:
  double slack_m_;
  std::vector<Vec3> corners_;
};

}  // namespace granrad
