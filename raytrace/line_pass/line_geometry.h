#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "raytrace/line_pass/line_pass.h"

namespace granrad {

/// Where the line of a cell runs and meets surfaces in the tile being emitted: metres from the middle of the
/// scene, depths along w, in double precision.
struct LineGeometry {
  const LinePass& pass;

  double u(std::int64_t cell) const {
    return (pass.column(cell) + pass.lattice().origin_u) * pass.scene().spacing;
  }
  double v(std::int64_t cell) const {
    return (pass.row(cell) + pass.lattice().origin_v) * pass.scene().spacing;
  }
  Vec3 point(std::int64_t cell, double depth) const {
    const LineFrame& f = pass.frame();
    return u(cell) * f.u + v(cell) * f.v + depth * f.w;
  }
  /// Depth at which the line leaves (side 1) or enters (side -1) a sphere or an image, or meets a wall.
  double depth(std::int32_t surface, std::int64_t cell, int side) const {
    const LineScene& scene = pass.scene();
    const LineFrame& f = pass.frame();
    const auto wall = surface - static_cast<std::int32_t>(scene.x.size());
    if (wall >= 0 && surface < scene.open_surface) {
      const LineScene::Face& face = scene.faces[scene.first_face[static_cast<std::size_t>(wall)]];
      return dot(face.corners[0] - point(cell, 0), face.normal) / dot(f.w, face.normal);
    }
    const LineBall ball = pass.ball(surface);
    const double du = u(cell) - dot(ball.centre, f.u), dv = v(cell) - dot(ball.centre, f.v);
    return dot(ball.centre, f.w) +
           side * std::sqrt(std::max(0.0, ball.radius * ball.radius - du * du - dv * dv));
  }
};

}  // namespace granrad
