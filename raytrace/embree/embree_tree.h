#pragma once
#include <cstdint>
#include <vector>

#include "dem/base/constants.h"
#include "raytrace/embree/tracing_geometry.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace granrad {

/// A ray in flight and the nearest things it has met. Lengths in tracing units, double precision; Embree's own
/// single-precision ray only steers the walk through the tree.
struct Query {
  Vec3 origin, direction;
  std::int32_t source_ball = -1;  ///< image the ray leaves, excluded by identity
  Vec3 source_normal{};           ///< of the wall the ray leaves, at its start, or zero
  bool seek_balls = true;
  std::vector<std::int32_t>* crossed =
      nullptr;  ///< gets every ball on the way to the limit, which then stays

  double ball_distance = infinity, ball_depth = 0;
  std::int32_t ball = -1;
  double front_distance = infinity, back_distance = infinity;
  std::int32_t facet = -1, back_facet = -1;
};

/// Spheres and the facets of no convex cell in Embree's tree.
class EmbreeTree : public TracingGeometry {
 public:
  EmbreeTree(const Enclosure& enclosure, int threads);
  ~EmbreeTree();
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  /// Fills in what the query meets within `limit`.
  void walk(Query& query, double limit) const;
  /// The face that hides `origin` from the centre of its sphere, or -1. It is no further from `origin` than the
  /// centre is.
  std::int32_t face_before(const Vec3& centre, const Vec3& origin) const;
  /// Whether a facet may reach inside the sphere.
  bool cut_by_wall(std::int32_t sphere) const { return cut_by_wall_[static_cast<std::size_t>(sphere)]; }

 private:
  void find_cut_spheres();

  std::vector<char> cut_by_wall_;  ///< per sphere
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
};

}  // namespace granrad
