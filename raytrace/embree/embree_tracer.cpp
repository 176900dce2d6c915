#include "raytrace/embree/embree_tracer.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "raytrace/embree/embree_tree.h"

namespace granrad {

struct EmbreeTracer::Impl : EmbreeTree {
  using EmbreeTree::EmbreeTree;

  enum class Met { nothing, ball, cell, facet, back };
  /// What a ray meets first; `number` of the ball or facet.
  struct Nearest {
    Met met;
    double distance;
    std::int32_t number;
  };

  Nearest trace(const Vec3& origin, const Vec3& direction, std::int32_t from, const Vec3& from_normal,
                Query& query, FacetHit& exit) const;
  bool has_left(const Vec3& origin, const Vec3& direction) const;
  Hit trace_periodic(Vec3 origin, const Vec3& direction, std::int32_t from, const Vec3& from_normal) const;
  bool wall_between_centre_and(const Vec3& origin, std::int32_t sphere, Query& query) const;
  bool starts_behind_wall(const Vec3& origin, std::int32_t from, Query& query) const;
  Nearest nearest(const Query& query, const FacetHit& exit, double limit) const;
  End end(const Nearest& n) const;
  Hit hit(const Nearest& n, const Query& query) const;
  bool is_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  Hit hit_on_facet(const Facets& facets, std::int32_t facet, const Vec3& point, double distance) const;
};

/// A sphere that a wall cuts emits into that wall from the part behind it, at distance zero.
bool EmbreeTracer::Impl::wall_between_centre_and(const Vec3& origin, std::int32_t sphere,
                                                 Query& query) const {
  const Vec3& centre = balls[static_cast<std::size_t>(sphere)].centre;
  const double length = norm(origin - centre);
  query.origin = centre;
  query.direction = (origin - centre) * (1 / length);
  query.seek_balls = false;
  walk(query, length);
  return query.facet >= 0 && query.front_distance < length - loose_facets->tolerance();
}

Hit EmbreeTracer::Impl::hit_on_facet(const Facets& facets, std::int32_t facet, const Vec3& point,
                                     double distance) const {
  const Vec3& n = facets.normal(facet);
  return {spheres + facets.wall(facet), distance * unit_m, to_metres(point - facets.height(facet, point) * n),
          n};
}

/// The nearest of what the walk through the tree met and the exit of the convex cell.
EmbreeTracer::Impl::Nearest EmbreeTracer::Impl::nearest(const Query& query, const FacetHit& exit,
                                                        double limit) const {
  const double wall = std::min(exit.distance, query.front_distance);
  const double first = std::min(wall, query.ball_distance);
  if (query.back_distance < first - loose_facets->tolerance() && query.back_distance <= limit)
    return {Met::back, query.back_distance, query.back_facet};
  if (!(first <= limit) || first == infinity) return {Met::nothing, infinity, -1};
  if (query.ball_distance < wall || query.ball_depth > 0) return {Met::ball, query.ball_distance, query.ball};
  return exit.distance <= query.front_distance ? Nearest{Met::cell, wall, exit.facet}
                                               : Nearest{Met::facet, wall, query.facet};
}

End EmbreeTracer::Impl::end(const Nearest& n) const {
  const double distance = n.distance * unit_m;
  switch (n.met) {
    case Met::back:
      return {-1, distance};
    case Met::ball:
      return {sphere_of_ball[static_cast<std::size_t>(n.number)], distance};
    case Met::cell:
      return {spheres + cell_facets->wall(n.number), distance};
    case Met::facet:
      return {spheres + loose_facets->wall(n.number), distance};
    case Met::nothing:
      break;
  }
  return {open, infinity};
}

Hit EmbreeTracer::Impl::hit(const Nearest& n, const Query& query) const {
  const auto at = [&] { return query.origin + n.distance * query.direction; };
  switch (n.met) {
    case Met::back:
      return {-1, n.distance * unit_m, to_metres(at()), {}, loose_facets->wall(n.number)};
    case Met::ball: {
      const auto sphere = static_cast<std::size_t>(sphere_of_ball[static_cast<std::size_t>(n.number)]);
      const Vec3 normal = normalized(at() - balls[static_cast<std::size_t>(n.number)].centre);
      return {static_cast<std::int32_t>(sphere), n.distance * unit_m,
              to_metres(balls[sphere].centre + balls[sphere].radius * normal), normal};
    }
    case Met::cell:
      return hit_on_facet(*cell_facets, n.number, at(), n.distance);
    case Met::facet:
      return hit_on_facet(*loose_facets, n.number, at(), n.distance);
    case Met::nothing:
      break;
  }
  return {open, infinity, {}, {}};
}

/// Whether a wall hides the start of a ray from the centre of the sphere it leaves: `query.facet` is the one.
bool EmbreeTracer::Impl::starts_behind_wall(const Vec3& origin, std::int32_t from, Query& query) const {
  return from >= 0 && from < spheres && cut_by_wall(from) && wall_between_centre_and(origin, from, query);
}

EmbreeTracer::Impl::Nearest EmbreeTracer::Impl::trace(const Vec3& origin, const Vec3& direction,
                                                      std::int32_t from, const Vec3& from_normal,
                                                      Query& query, FacetHit& exit) const {
  query.origin = origin;
  query.direction = direction;
  if (from >= 0 && from < spheres)
    query.source_ball = from;
  else if (from >= 0)
    query.source_normal = from_normal;
  exit = cell ? cell->exit(*cell_facets, origin, direction) : FacetHit{infinity, -1};
  if (exit.distance > 0) walk(query, exit.distance);
  return nearest(query, exit, infinity);
}

/// Whether a ray is beyond everything in a direction that does not repeat, on its way out.
bool EmbreeTracer::Impl::has_left(const Vec3& origin, const Vec3& direction) const {
  for (int k = 0; k < 3; ++k)
    if (!periodic[k] &&
        ((direction[k] > 0 && origin[k] > high[k]) || (direction[k] < 0 && origin[k] < low[k])))
      return true;
  return false;
}

/// Follows the ray from period to period: the origin is kept inside the box, the image of the sphere it left
/// moves along with it. A ray that meets nothing in `most_periods` is lost.
Hit EmbreeTracer::Impl::trace_periodic(Vec3 origin, const Vec3& direction, std::int32_t from,
                                       const Vec3& from_normal) const {
  const Vec3 period = box_max - box_min;
  const bool from_sphere = from >= 0 && from < spheres;
  Vec3 source = from_sphere ? balls[static_cast<std::size_t>(from)].centre : Vec3{};
  for (int k = 0; k < 3; ++k) {
    if (!periodic[k]) continue;
    if (from_sphere) source[k] += period[k] * std::round((origin[k] - source[k]) / period[k]);
    const double shift = period[k] * std::floor((origin[k] - box_min[k]) / period[k]);
    origin[k] -= shift;
    source[k] -= shift;
  }
  if (from_sphere && cut_by_wall(from))
    if (const auto facet = face_before(source, origin); facet >= 0)
      return hit_on_facet(*loose_facets, facet, origin, 0);

  double travelled = 0;
  for (std::int64_t crossing = 0; crossing < most_periods; ++crossing) {
    int axis = 0;
    double limit = infinity;
    for (int k = 0; k < 3; ++k) {
      if (!periodic[k] || direction[k] == 0) continue;
      const double t = ((direction[k] > 0 ? box_max[k] : box_min[k]) - origin[k]) / direction[k];
      if (t < limit) {
        limit = std::max(0.0, t);
        axis = k;
      }
    }
    Query query;
    query.origin = origin;
    query.direction = direction;
    if (from_sphere)
      query.source_ball = image_at(from, source);
    else if (from >= 0 && crossing == 0)
      query.source_normal = from_normal;
    walk(query, limit);
    const Nearest found = nearest(query, {infinity, -1}, limit);
    if (found.met != Met::nothing || limit == infinity) {
      Hit there = hit(found, query);
      there.distance_m += travelled * unit_m;
      return there;
    }
    if (has_left(origin, direction)) return {open, infinity, {}, {}};
    travelled += limit;
    origin += limit * direction;
    const double jump = direction[axis] > 0 ? -period[axis] : period[axis];
    origin[axis] = direction[axis] > 0 ? box_min[axis] : box_max[axis];
    source[axis] += jump;
  }
  return {-1, travelled * unit_m, to_metres(origin), {}};
}

EmbreeTracer::EmbreeTracer(const Enclosure& enclosure, int threads)
    : impl_(std::make_unique<Impl>(enclosure, threads)) {}
EmbreeTracer::~EmbreeTracer() = default;

bool EmbreeTracer::is_closed() const {
  return impl_->cell.has_value();
}

bool EmbreeTracer::is_convex() const {
  return is_closed() && impl_->loose_facets->count() == 0;
}

Hit EmbreeTracer::first_hit(const Vec3& origin, const Vec3& direction, std::int32_t from,
                            const Vec3& from_normal) const {
  const Vec3 start = impl_->to_units(origin);
  if (impl_->is_periodic()) return impl_->trace_periodic(start, direction, from, from_normal);
  Query behind;
  if (impl_->starts_behind_wall(start, from, behind))
    return impl_->hit_on_facet(*impl_->loose_facets, behind.facet, start, 0);
  Query query;
  FacetHit exit;
  return impl_->hit(impl_->trace(start, direction, from, from_normal, query, exit), query);
}

Hit EmbreeTracer::first_hit_and_crossed(const Vec3& origin, const Vec3& direction, std::int32_t from,
                                        const Vec3& from_normal, Crossed& crossed) const {
  const Vec3 start = impl_->to_units(origin);
  crossed.spheres.clear();
  Query query;
  if (from >= impl_->spheres) query.crossed = &crossed.spheres;
  FacetHit exit;
  const Impl::Nearest nearest = impl_->trace(start, direction, from, from_normal, query, exit);
  crossed.wall = impl_->spheres + impl_->cell_facets->wall(exit.facet);
  return impl_->hit(nearest, query);
}

End EmbreeTracer::first_end(const Vec3& origin, const Vec3& direction, std::int32_t from,
                            const Vec3& from_normal) const {
  const Vec3 start = impl_->to_units(origin);
  if (impl_->is_periodic()) {
    const Hit hit = impl_->trace_periodic(start, direction, from, from_normal);
    return {hit.surface, hit.distance_m};
  }
  Query behind;
  if (impl_->starts_behind_wall(start, from, behind))
    return {impl_->spheres + impl_->loose_facets->wall(behind.facet), 0};
  Query query;
  FacetHit exit;
  return impl_->end(impl_->trace(start, direction, from, from_normal, query, exit));
}

}  // namespace granrad
