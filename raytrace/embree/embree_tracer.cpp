#include "raytrace/embree/embree_tracer.h"

#if GRANRAD_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "raytrace/embree/tracing_geometry.h"

namespace granrad {

namespace {

// Embree 3 and 4 differ here alone: the name of what a query carries to the callbacks, and how it is handed over.
#if GRANRAD_EMBREE_MAJOR >= 4
using QueryContext = RTCRayQueryContext;

void intersect(RTCScene scene, QueryContext& context, RTCRayHit& rayhit) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &rayhit, &arguments);
}
#else
using QueryContext = RTCIntersectContext;

void intersect(RTCScene scene, QueryContext& context, RTCRayHit& rayhit) {
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayhit);
}
#endif

/// A ray in flight and the nearest things it has met: what the Embree callbacks read and write. Lengths in
/// tracing units, double precision; Embree's own single-precision ray only steers the walk through the tree.
struct Query : QueryContext {
  Vec3 origin, direction;
  std::int32_t source_ball = -1;  ///< image the ray leaves, excluded by identity
  Vec3 source_normal{};           ///< of the wall the ray leaves, at its start, or zero
  bool seek_balls = true;

  double ball_distance = infinity, ball_depth = 0;
  std::int32_t ball = -1;
  double front_distance = infinity, back_distance = infinity;
  std::int32_t facet = -1, back_facet = -1;
};

void shorten(RTCRayHitN* rayhit, double distance, double margin) {
  auto& ray = reinterpret_cast<RTCRayHit*>(rayhit)->ray;
  const float limit = static_cast<float>((distance + margin) * (1 + 1e-6));
  ray.tfar = std::min(ray.tfar, limit);
}

}  // namespace

struct EmbreeTracer::Impl : TracingGeometry {
  Impl(const Enclosure& enclosure, int threads);
  ~Impl();

  enum class Met { nothing, ball, cell, facet, back };
  /// What a ray meets first; `number` of the ball or facet.
  struct Nearest {
    Met met;
    double distance;
    std::int32_t number;
  };

  Nearest trace(const Vec3& origin, const Vec3& direction, std::int32_t from, const Vec3& from_normal,
                Query& query) const;
  bool has_left(const Vec3& origin, const Vec3& direction) const;
  Hit trace_periodic(Vec3 origin, const Vec3& direction, std::int32_t from, const Vec3& from_normal) const;
  void walk(Query& query, double limit) const;
  bool wall_between_centre_and(const Vec3& origin, std::int32_t sphere, Query& query) const;
  bool starts_behind_wall(const Vec3& origin, std::int32_t from, Query& query) const;
  Nearest nearest(const Query& query, const FacetHit& exit, double limit) const;
  End end(const Nearest& n) const;
  Hit hit(const Nearest& n, const Query& query) const;
  bool is_periodic() const { return periodic[0] || periodic[1] || periodic[2]; }
  Hit hit_on_facet(const Facets& facets, std::int32_t facet, const Vec3& point, double distance) const;

  void attach(std::size_t count, RTCBoundsFunction bounds, RTCIntersectFunctionN intersect);
  void find_cut_spheres();
  std::int32_t face_before(const Vec3& centre, const Vec3& origin) const;

  static void ball_bounds(const RTCBoundsFunctionArguments* args);
  static void facet_bounds(const RTCBoundsFunctionArguments* args);
  static void meet_ball(const RTCIntersectFunctionNArguments* args);
  static void meet_facet(const RTCIntersectFunctionNArguments* args);

  std::vector<char> cut_by_wall;  ///< per sphere: a facet may reach inside it
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

void EmbreeTracer::Impl::attach(std::size_t count, RTCBoundsFunction bounds,
                                RTCIntersectFunctionN intersect) {
  if (count == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

EmbreeTracer::Impl::Impl(const Enclosure& enclosure, int threads) : TracingGeometry(enclosure) {
  const int build_threads = threads > 0 ? threads : omp_get_max_threads();
  device = rtcNewDevice(fmt::format("threads={}", build_threads).c_str());
  if (!device) throw NumericalError("Embree: no device");
  scene = rtcNewScene(device);
  attach(balls.size(), ball_bounds, meet_ball);
  attach(static_cast<std::size_t>(loose_facets->count()), facet_bounds, meet_facet);
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw NumericalError(fmt::format("Embree: error {} while building the tree", static_cast<int>(error)));
  find_cut_spheres();
}

EmbreeTracer::Impl::~Impl() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void EmbreeTracer::Impl::ball_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& impl = *static_cast<const Impl*>(args->geometryUserPtr);
  const Ball& ball = impl.balls[args->primID];
  const double r = ball.radius + impl.pad;
  auto& b = *args->bounds_o;
  b.lower_x = static_cast<float>(ball.centre.x - r);
  b.lower_y = static_cast<float>(ball.centre.y - r);
  b.lower_z = static_cast<float>(ball.centre.z - r);
  b.upper_x = static_cast<float>(ball.centre.x + r);
  b.upper_y = static_cast<float>(ball.centre.y + r);
  b.upper_z = static_cast<float>(ball.centre.z + r);
}

void EmbreeTracer::Impl::facet_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& impl = *static_cast<const Impl*>(args->geometryUserPtr);
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const Vec3& v : impl.loose_facets->vertices(static_cast<std::int32_t>(args->primID)))
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k] - impl.pad);
      high[k] = std::max(high[k], v[k] + impl.pad);
    }
  *args->bounds_o = {static_cast<float>(low.x),  static_cast<float>(low.y),  static_cast<float>(low.z),  0,
                     static_cast<float>(high.x), static_cast<float>(high.y), static_cast<float>(high.z), 0};
}

void EmbreeTracer::Impl::meet_ball(const RTCIntersectFunctionNArguments* args) {
  const auto& impl = *static_cast<const Impl*>(args->geometryUserPtr);
  auto& query = *static_cast<Query*>(args->context);
  const auto number = static_cast<std::int32_t>(args->primID);
  if (!args->valid[0] || number == query.source_ball || !query.seek_balls) return;
  const Ball& ball = impl.balls[args->primID];
  const Vec3 to_centre = ball.centre - query.origin;
  const double r2 = ball.radius * ball.radius;
  const double outside = dot(to_centre, to_centre) - r2;
  if (outside < 0) {  // starts inside a neighbour: on it, at distance zero; the deepest wins
    const double depth = ball.radius - std::sqrt(outside + r2);
    if (depth > query.ball_depth || (depth == query.ball_depth && number < query.ball)) {
      query.ball_depth = depth;
      query.ball_distance = 0;
      query.ball = number;
      shorten(args->rayhit, 0, 2 * impl.pad);
    }
    return;
  }
  const double along = dot(to_centre, query.direction);
  if (along <= 0) return;
  const Vec3 across = to_centre - along * query.direction;
  const double half_chord2 = r2 - dot(across, across);
  if (half_chord2 < 0) return;
  const double t = std::max(0.0, along - std::sqrt(half_chord2));
  const bool tie = t == query.ball_distance && query.ball_depth == 0 && number < query.ball;
  if (t < query.ball_distance || tie) {
    query.ball_distance = t;
    query.ball = number;
    shorten(args->rayhit, t, 2 * impl.pad);
  }
}

void EmbreeTracer::Impl::meet_facet(const RTCIntersectFunctionNArguments* args) {
  const auto& impl = *static_cast<const Impl*>(args->geometryUserPtr);
  auto& query = *static_cast<Query*>(args->context);
  const auto facet = static_cast<std::int32_t>(args->primID);
  if (!args->valid[0]) return;
  const Facets& facets = *impl.loose_facets;
  const double front = facets.front_crossing(facet, query.origin, query.direction);
  const bool own_back =
      front <= facets.tolerance() && dot(facets.normal(facet), query.source_normal) < -1 + 1e-9;
  if (front < infinity && !own_back) {
    if (front < query.front_distance || (front == query.front_distance && facet < query.facet)) {
      query.front_distance = front;
      query.facet = facet;
      shorten(args->rayhit, front, 2 * impl.pad);
    }
    return;
  }
  const double back = facets.back_crossing(facet, query.origin, query.direction);
  if (back < query.back_distance) {
    query.back_distance = back;
    query.back_facet = facet;
    shorten(args->rayhit, back, 2 * impl.pad);
  }
}

void EmbreeTracer::Impl::find_cut_spheres() {
  cut_by_wall.assign(static_cast<std::size_t>(spheres), 0);
  if (loose_facets->count() == 0) return;
  struct Found {
    const Impl* impl;
    bool any;
  };
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    if (args->geomID != (static_cast<Found*>(args->userPtr)->impl->balls.empty() ? 0u : 1u)) return false;
    static_cast<Found*>(args->userPtr)->any = true;
    return false;
  };
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < spheres; ++i) {
    const Ball& ball = balls[static_cast<std::size_t>(i)];
    RTCPointQuery point{static_cast<float>(ball.centre.x), static_cast<float>(ball.centre.y),
                        static_cast<float>(ball.centre.z), 0, static_cast<float>(ball.radius + pad)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Found found{this, false};
    rtcPointQuery(scene, &point, &context, visit, &found);
    cut_by_wall[static_cast<std::size_t>(i)] = found.any;
  }
}

/// The face that hides `origin` from the centre of its sphere, or -1. It is no further from `origin` than the
/// centre is.
std::int32_t EmbreeTracer::Impl::face_before(const Vec3& centre, const Vec3& origin) const {
  struct Asked {
    const Impl* impl;
    const Vec3 &centre, &origin;
    std::int32_t face;
  };
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    auto& asked = *static_cast<Asked*>(args->userPtr);
    const Impl& impl = *asked.impl;
    if (args->geomID != (impl.balls.empty() ? 0u : 1u)) return false;
    const auto face = static_cast<std::int32_t>(args->primID);
    if ((asked.face < 0 || face < asked.face) && impl.hides(face, asked.centre, asked.origin))
      asked.face = face;
    return false;
  };
  RTCPointQuery point{static_cast<float>(origin.x), static_cast<float>(origin.y),
                      static_cast<float>(origin.z), 0, static_cast<float>(norm(origin - centre) + 2 * pad)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  Asked asked{this, centre, origin, -1};
  rtcPointQuery(scene, &point, &context, visit, &asked);
  return asked.face;
}

void EmbreeTracer::Impl::walk(Query& query, double limit) const {
  RTCRayHit rayhit;
  rayhit.ray = {
      static_cast<float>(query.origin.x),
      static_cast<float>(query.origin.y),
      static_cast<float>(query.origin.z),
      0,
      static_cast<float>(query.direction.x),
      static_cast<float>(query.direction.y),
      static_cast<float>(query.direction.z),
      0,
      std::min(static_cast<float>(limit * (1 + 1e-6) + 2 * pad), std::numeric_limits<float>::infinity()),
      ~0u,
      0,
      0};
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(scene, query, rayhit);
}

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
  return from >= 0 && from < spheres && cut_by_wall[static_cast<std::size_t>(from)] &&
         wall_between_centre_and(origin, from, query);
}

EmbreeTracer::Impl::Nearest EmbreeTracer::Impl::trace(const Vec3& origin, const Vec3& direction,
                                                      std::int32_t from, const Vec3& from_normal,
                                                      Query& query) const {
  query.origin = origin;
  query.direction = direction;
  if (from >= 0 && from < spheres)
    query.source_ball = from;
  else if (from >= 0)
    query.source_normal = from_normal;
  const FacetHit exit = cell ? cell->exit(*cell_facets, origin, direction) : FacetHit{infinity, -1};
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
  if (from_sphere && cut_by_wall[static_cast<std::size_t>(from)])
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

Hit EmbreeTracer::first_hit(const Vec3& origin, const Vec3& direction, std::int32_t from,
                            const Vec3& from_normal) const {
  const Vec3 start = impl_->to_units(origin);
  if (impl_->is_periodic()) return impl_->trace_periodic(start, direction, from, from_normal);
  Query behind;
  if (impl_->starts_behind_wall(start, from, behind))
    return impl_->hit_on_facet(*impl_->loose_facets, behind.facet, start, 0);
  Query query;
  return impl_->hit(impl_->trace(start, direction, from, from_normal, query), query);
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
  return impl_->end(impl_->trace(start, direction, from, from_normal, query));
}

}  // namespace granrad
