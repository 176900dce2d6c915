#pragma once
#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "raytrace/rays/emission.h"
#include "tests/bench/trace_case.h"

/// What one would write first: SPHERE_POINT, two triangles a wall, independent random rays, a hit on the sphere left is
/// filtered.

namespace granrad::trace_bench {

struct SkipSource {
  RTCIntersectContext context;
  unsigned sphere_geometry, source;
};

inline void skip_source(const RTCFilterFunctionNArguments* args) {
  const auto* skip = reinterpret_cast<const SkipSource*>(args->context);
  if (RTCHitN_primID(args->hit, 1, 0) == skip->source &&
      RTCHitN_geomID(args->hit, 1, 0) == skip->sphere_geometry)
    args->valid[0] = 0;
}

class BareEmbree {
 public:
  explicit BareEmbree(const Enclosure& e)
      : e_(e), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    RTCGeometry spheres = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* v = static_cast<float*>(
        rtcSetNewGeometryBuffer(spheres, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, e.sphere_count()));
    for (std::size_t i = 0; i < e.sphere_count(); ++i) {
      for (int k = 0; k < 3; ++k)
        v[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(e.centre_m[i][k] / radius);
      v[4 * i + 3] = 1;
    }
    rtcSetGeometryIntersectFilterFunction(spheres, skip_source);
    sphere_geometry_ = attach(spheres);
    for (const Wall& wall : e.walls) {
      RTCGeometry quad = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* corner = static_cast<float*>(
          rtcSetNewGeometryBuffer(quad, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4));
      for (std::size_t k = 0; k < 12; ++k)
        corner[k] = static_cast<float>(wall.vertices[k / 3][static_cast<int>(k % 3)] / radius);
      auto* index = static_cast<unsigned*>(
          rtcSetNewGeometryBuffer(quad, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 2));
      for (unsigned k = 0; k < 6; ++k) index[k] = std::array{0u, 1u, 2u, 0u, 2u, 3u}[k];
      attach(quad);
    }
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  /// Surface hit by a ray from sphere i; -1: none.
  std::int64_t hit(std::size_t i, const Emission& ray) const {
    SkipSource skip;
    rtcInitIntersectContext(&skip.context);
    skip.sphere_geometry = sphere_geometry_;
    skip.source = static_cast<unsigned>(i);
    RTCRayHit query{};
    for (int k = 0; k < 3; ++k) {
      (&query.ray.org_x)[k] = static_cast<float>(ray.origin_m[k] / radius);
      (&query.ray.dir_x)[k] = static_cast<float>(ray.direction[k]);
    }
    query.ray.tfar = INFINITY;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &skip.context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return -1;
    if (query.hit.geomID == sphere_geometry_) return query.hit.primID;
    return static_cast<std::int64_t>(e_.sphere_count() + query.hit.geomID - sphere_geometry_ - 1);
  }

 private:
  unsigned attach(RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    return id;
  }
  const Enclosure& e_;
  RTCDevice device_;
  RTCScene scene_;
  unsigned sphere_geometry_ = 0;
};

Result bare_embree(const Case& c, double rays_per_particle, unsigned seed);

}  // namespace granrad::trace_bench
