#pragma once
#include <algorithm>

#include "dem/base/constants.h"
#include "dem/base/vec3.h"

namespace granrad {

/// Axis-aligned box.
struct Box {
  Vec3 min{}, max{};

  /// Holds nothing: `include` makes it the bounds of what it is given.
  static Box empty() { return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}; }
  bool is_empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  /// Grows so that it holds the ball of radius `margin` about p.
  void include(const Vec3& p, double margin = 0) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], p[axis] - margin);
      max[axis] = std::max(max[axis], p[axis] + margin);
    }
  }
  Vec3 size() const { return max - min; }
  Vec3 middle() const { return 0.5 * (min + max); }
  double volume() const { return size().x * size().y * size().z; }
  bool contains(const Vec3& p) const {
    return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
  }
  /// Whether the two have a point in common, or come within `margin` of it along every axis.
  bool meets(const Box& other, double margin = 0) const {
    for (int axis = 0; axis < 3; ++axis)
      if (min[axis] > other.max[axis] + margin || other.min[axis] > max[axis] + margin) return false;
    return true;
  }
};

}  // namespace granrad
