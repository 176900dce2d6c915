#include "raytrace/embree/tracing_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

TracingGeometry::TracingGeometry(const Enclosure& enclosure)
    : spheres(static_cast<std::int32_t>(enclosure.sphere_count())),
      open(static_cast<std::int32_t>(enclosure.open_surface())),
      periodic(enclosure.periodic) {
  choose_units(enclosure);
  add_balls(enclosure);
  add_facets(enclosure);
  count_periods(enclosure);
}

/// Free paths between the bodies of a lattice have a long tail, P(> n periods) of about a tenth of mean / n (straight
/// channels): rays get 10^4 mean free paths 4 V / S. Beds too thin for that many steps lose theirs soon, and the caller
/// refuses them.
void TracingGeometry::count_periods(const Enclosure& enclosure) {
  constexpr double usual = 1e4, most = 1e7;
  const auto areas = surface_areas(enclosure);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  const Vec3 size = unit_m * (high - low);
  double shortest = infinity;
  for (int k = 0; k < 3; ++k)
    if (periodic[k]) shortest = std::min(shortest, enclosure.box.size()[k]);
  const double periods = 4 * size.x * size.y * size.z / (area * shortest);  // of a mean free path
  most_periods = static_cast<std::int64_t>(periods * usual <= most ? std::max(1.0, periods) * usual : usual);
}

void TracingGeometry::choose_units(const Enclosure& enclosure) {
  Box all = Box::empty();
  std::vector<std::string> problems;
  double radius_sum = 0;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const Vec3& c = enclosure.centre_m[i];
    const double r = enclosure.radius_m[i];
    if (!is_finite(c) || !std::isfinite(r) || r <= 0) {
      problems.push_back(
          fmt::format("sphere {}: centre = ({}, {}, {}), radius = {} (must be finite, radius "
                      "positive)",
                      i, c.x, c.y, c.z, r));
      continue;
    }
    radius_sum += r;
    all.include(c, r);
  }
  for (const Wall& wall : enclosure.walls)
    for (const Vec3& v : wall.vertices) {
      if (!is_finite(v)) problems.push_back(fmt::format("wall '{}': a vertex is not finite", wall.name));
      all.include(v);
    }
  if (!problems.empty()) throw InputError(problems);
  for (int k = 0; k < 3; ++k)
    if (periodic[k]) {
      for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
        if (2 * enclosure.radius_m[i] >= enclosure.box.size()[k])
          throw InputError(
              fmt::format("sphere {}: radius = {} m (its diameter must be smaller than the period "
                          "{} m)",
                          i, enclosure.radius_m[i], enclosure.box.size()[k]));
      all.min[k] = enclosure.box.min[k];
      all.max[k] = enclosure.box.max[k];
    }
  if (all.is_empty()) return;  // nothing but surroundings
  centre_m = all.middle();
  const double extent = norm(all.size());
  unit_m = spheres > 0 ? radius_sum / spheres : extent / 100;
  pad = 1e-6 * extent / unit_m;
  low = to_units(all.min) - Vec3{pad, pad, pad};
  high = to_units(all.max) + Vec3{pad, pad, pad};
  box_min = to_units(enclosure.box.min);
  box_max = to_units(enclosure.box.max);
}

void TracingGeometry::add_balls(const Enclosure& enclosure) {
  for (std::int32_t i = 0; i < spheres; ++i) {
    balls.push_back({to_units(enclosure.centre_m[i]), enclosure.radius_m[i] / unit_m});
    sphere_of_ball.push_back(i);
  }
  if (!periodic[0] && !periodic[1] && !periodic[2]) return;
  const Vec3 period = box_max - box_min;
  for (std::int32_t i = 0; i < spheres; ++i) {
    first_image.push_back(static_cast<std::int32_t>(balls.size()));
    for (int k = 0; k < 3; ++k)
      if (periodic[k])
        balls[i].centre[k] -= period[k] * std::floor((balls[i].centre[k] - box_min[k]) / period[k]);
    for (int image = 0; image < 27; ++image) {
      const int shift[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
      Ball ball = balls[i];
      bool wanted = image != 13;
      for (int k = 0; k < 3; ++k) {
        wanted = wanted && (shift[k] == 0 || periodic[k]);
        ball.centre[k] += shift[k] * period[k];
        if (periodic[k])
          wanted = wanted && ball.centre[k] + ball.radius > box_min[k] &&
                   ball.centre[k] - ball.radius < box_max[k];
      }
      if (!wanted) continue;
      balls.push_back(ball);
      sphere_of_ball.push_back(i);
    }
  }
  first_image.push_back(static_cast<std::int32_t>(balls.size()));
}

void TracingGeometry::add_facets(const Enclosure& enclosure) {
  double farthest_m = 0;
  for (const Wall& wall : enclosure.walls)
    for (const Vec3& v : wall.vertices) farthest_m = std::max(farthest_m, norm(v));
  const double tolerance = 1e-9 + 16 * std::numeric_limits<double>::epsilon() * farthest_m / unit_m;
  cell_facets.emplace(tolerance);
  loose_facets.emplace(tolerance);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    const bool planar = plane_of(enclosure.walls[w]).has_value();
    if (planar) cell_facets->add(enclosure.walls[w], static_cast<std::int32_t>(w), centre_m, 1 / unit_m);
    is_planar.push_back(planar);
  }
  if (!periodic[0] && !periodic[1] && !periodic[2]) cell = ConvexCell::from(*cell_facets);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    if (!cell || !is_planar[w])
      loose_facets->add(enclosure.walls[w], static_cast<std::int32_t>(w), centre_m, 1 / unit_m);
}

std::int32_t TracingGeometry::image_at(std::int32_t sphere, const Vec3& centre) const {
  const auto same = [&](std::int32_t ball) {
    return norm(balls[static_cast<std::size_t>(ball)].centre - centre) <
           0.5 * balls[static_cast<std::size_t>(ball)].radius;
  };
  if (same(sphere)) return sphere;
  const auto begin = first_image[static_cast<std::size_t>(sphere)];
  const auto end = first_image[static_cast<std::size_t>(sphere) + 1];
  for (std::int32_t image = begin; image < end; ++image)
    if (same(image)) return image;
  return -1;
}

bool TracingGeometry::hides(std::int32_t face, const Vec3& centre, const Vec3& origin) const {
  const Facets& f = *loose_facets;
  const double h = f.height(face, origin);
  return h < -f.tolerance() && f.height(face, centre) > 0 &&
         f.edge_margin(face, origin - h * f.normal(face)) >= -f.tolerance();
}

}  // namespace granrad
