#include "raytrace/embree/embree_tree.h"

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

#include "dem/base/error.h"

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

/// What a query carries to the callbacks.
struct Walk : QueryContext {
  Query* query = nullptr;
};

void shorten(const Query& query, RTCRayHitN* rayhit, double distance, double margin) {
  if (query.crossed) return;
  auto& ray = reinterpret_cast<RTCRayHit*>(rayhit)->ray;
  const float limit = static_cast<float>((distance + margin) * (1 + 1e-6));
  ray.tfar = std::min(ray.tfar, limit);
}

void ball_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& tree = *static_cast<const EmbreeTree*>(args->geometryUserPtr);
  const Ball& ball = tree.balls[args->primID];
  const double r = ball.radius + tree.pad;
  auto& b = *args->bounds_o;
  b.lower_x = static_cast<float>(ball.centre.x - r);
  b.lower_y = static_cast<float>(ball.centre.y - r);
  b.lower_z = static_cast<float>(ball.centre.z - r);
  b.upper_x = static_cast<float>(ball.centre.x + r);
  b.upper_y = static_cast<float>(ball.centre.y + r);
  b.upper_z = static_cast<float>(ball.centre.z + r);
}

void facet_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& tree = *static_cast<const EmbreeTree*>(args->geometryUserPtr);
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const Vec3& v : tree.loose_facets->vertices(static_cast<std::int32_t>(args->primID)))
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k] - tree.pad);
      high[k] = std::max(high[k], v[k] + tree.pad);
    }
  *args->bounds_o = {static_cast<float>(low.x),  static_cast<float>(low.y),  static_cast<float>(low.z),  0,
                     static_cast<float>(high.x), static_cast<float>(high.y), static_cast<float>(high.z), 0};
}

void meet_ball(const RTCIntersectFunctionNArguments* args) {
  const auto& tree = *static_cast<const EmbreeTree*>(args->geometryUserPtr);
  Query& query = *static_cast<Walk*>(args->context)->query;
  const auto number = static_cast<std::int32_t>(args->primID);
  if (!args->valid[0] || number == query.source_ball || !query.seek_balls) return;
  const Ball& ball = tree.balls[args->primID];
  const Vec3 to_centre = ball.centre - query.origin;
  const double r2 = ball.radius * ball.radius;
  const double outside = dot(to_centre, to_centre) - r2;
  if (outside < 0) {  // starts inside a neighbour: on it, at distance zero; the deepest wins
    const double depth = ball.radius - std::sqrt(outside + r2);
    if (depth > query.ball_depth || (depth == query.ball_depth && number < query.ball)) {
      query.ball_depth = depth;
      query.ball_distance = 0;
      query.ball = number;
      shorten(query, args->rayhit, 0, 2 * tree.pad);
    }
    return;
  }
  const double along = dot(to_centre, query.direction);
  if (along <= 0) return;
  const Vec3 across = to_centre - along * query.direction;
  const double half_chord2 = r2 - dot(across, across);
  if (half_chord2 < 0) return;
  if (query.crossed) query.crossed->push_back(number);
  const double t = std::max(0.0, along - std::sqrt(half_chord2));
  const bool tie = t == query.ball_distance && query.ball_depth == 0 && number < query.ball;
  if (t < query.ball_distance || tie) {
    query.ball_distance = t;
    query.ball = number;
    shorten(query, args->rayhit, t, 2 * tree.pad);
  }
}

void meet_facet(const RTCIntersectFunctionNArguments* args) {
  const auto& tree = *static_cast<const EmbreeTree*>(args->geometryUserPtr);
  Query& query = *static_cast<Walk*>(args->context)->query;
  const auto facet = static_cast<std::int32_t>(args->primID);
  if (!args->valid[0]) return;
  const Facets& facets = *tree.loose_facets;
  const double front = facets.front_crossing(facet, query.origin, query.direction);
  const bool own_back =
      front <= facets.tolerance() && dot(facets.normal(facet), query.source_normal) < -1 + 1e-9;
  if (front < infinity && !own_back) {
    if (front < query.front_distance || (front == query.front_distance && facet < query.facet)) {
      query.front_distance = front;
      query.facet = facet;
      shorten(query, args->rayhit, front, 2 * tree.pad);
    }
    return;
  }
  const double back = facets.back_crossing(facet, query.origin, query.direction);
  if (back < query.back_distance) {
    query.back_distance = back;
    query.back_facet = facet;
    shorten(query, args->rayhit, back, 2 * tree.pad);
  }
}

void attach(RTCDevice device, RTCScene scene, const EmbreeTree& tree, std::size_t count,
            RTCBoundsFunction bounds, RTCIntersectFunctionN intersect) {
  if (count == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, const_cast<EmbreeTree*>(&tree));
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

EmbreeTree::EmbreeTree(const Enclosure& enclosure, int threads) : TracingGeometry(enclosure) {
  const int build_threads = threads > 0 ? threads : omp_get_max_threads();
  device_ = rtcNewDevice(fmt::format("threads={}", build_threads).c_str());
  if (!device_) throw NumericalError("Embree: no device");
  scene_ = rtcNewScene(device_);
  attach(device_, scene_, *this, balls.size(), ball_bounds, meet_ball);
  attach(device_, scene_, *this, static_cast<std::size_t>(loose_facets->count()), facet_bounds, meet_facet);
  rtcCommitScene(scene_);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw NumericalError(fmt::format("Embree: error {} while building the tree", static_cast<int>(error)));
  find_cut_spheres();
}

EmbreeTree::~EmbreeTree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeTree::find_cut_spheres() {
  cut_by_wall_.assign(static_cast<std::size_t>(spheres), 0);
  if (loose_facets->count() == 0) return;
  struct Found {
    const EmbreeTree* tree;
    bool any;
  };
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    if (args->geomID != (static_cast<Found*>(args->userPtr)->tree->balls.empty() ? 0u : 1u)) return false;
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
    rtcPointQuery(scene_, &point, &context, visit, &found);
    cut_by_wall_[static_cast<std::size_t>(i)] = found.any;
  }
}

std::int32_t EmbreeTree::face_before(const Vec3& centre, const Vec3& origin) const {
  struct Asked {
    const EmbreeTree* tree;
    const Vec3 &centre, &origin;
    std::int32_t face;
  };
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    auto& asked = *static_cast<Asked*>(args->userPtr);
    const EmbreeTree& tree = *asked.tree;
    if (args->geomID != (tree.balls.empty() ? 0u : 1u)) return false;
    const auto face = static_cast<std::int32_t>(args->primID);
    if ((asked.face < 0 || face < asked.face) && tree.hides(face, asked.centre, asked.origin))
      asked.face = face;
    return false;
  };
  RTCPointQuery point{static_cast<float>(origin.x), static_cast<float>(origin.y),
                      static_cast<float>(origin.z), 0, static_cast<float>(norm(origin - centre) + 2 * pad)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  Asked asked{this, centre, origin, -1};
  rtcPointQuery(scene_, &point, &context, visit, &asked);
  return asked.face;
}

void EmbreeTree::walk(Query& query, double limit) const {
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
  Walk carried;
  carried.query = &query;
  intersect(scene_, carried, rayhit);
}

}  // namespace granrad
