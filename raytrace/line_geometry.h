#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "raytrace/line_lattice.h"

namespace granrad {

/// Where the line of a lattice cell runs and meets surfaces: metres from the middle of the scene, depths
/// along w, in double precision.
struct LineGeometry {
  const LineScene& scene;
  const LineFrame& frame;
  const LineLattice& lattice;

  double u(std::int64_t cell) const {
    return (static_cast<double>(cell % lattice.pitch) + lattice.origin_u) * scene.spacing;
  }
  double v(std::int64_t cell) const {
    return (static_cast<double>(cell / lattice.pitch) + lattice.origin_v) * scene.spacing;
  }
  Vec3 point(std::int64_t cell, double depth) const {
    return u(cell) * frame.u + v(cell) * frame.v + depth * frame.w;
  }
  /// Depth at which the line leaves (side 1) or enters (side -1) a sphere.
  double sphere(const Vec3& centre, double radius, std::int64_t cell, int side) const {
    const double du = u(cell) - dot(centre, frame.u), dv = v(cell) - dot(centre, frame.v);
    return dot(centre, frame.w) + side * std::sqrt(std::max(0.0, radius * radius - du * du - dv * dv));
  }
  double face(const LineScene::Face& face, std::int64_t cell) const {
    return dot(face.corners[0] - point(cell, 0), face.normal) / dot(frame.w, face.normal);
  }
};

}  // namespace granrad
