#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// Where a ray ends.
struct Hit {
  std::int32_t surface;  ///< surface number of the enclosure; open_surface() when nothing is met; -1: leaked
  double distance_m;     ///< infinite for the surroundings
  Vec3 position_m;       ///< on the surface (for spheres projected onto it in double precision)
  Vec3 normal;           ///< unit, towards the void
  std::int32_t back_of = -1;  ///< leaked: the wall (not surface) whose back was met
};

/// Where a ray ends, without the place: all that view factors need.
struct End {
  std::int32_t surface;
  double distance_m;
};

/// First hits in an enclosure of spheres and walls, by Embree user geometry tested in double precision.
/// Geometry is recentred and divided by the mean radius before it reaches single precision; planar polygons
/// are intersected analytically, meshes as ROBUST triangles. The only user of rtcore.h.
class EmbreeTracer {
 public:
  explicit EmbreeTracer(const Enclosure& enclosure, int threads = 0);
  ~EmbreeTracer();
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  /// Whether a room is convex with flat walls and nothing but spheres in it.
  bool is_convex() const;
  /// Whether no ray can reach the surroundings, for planar walls are the whole boundary of a convex room.
  bool is_closed() const;

  /// Follows a ray from `origin` (on surface `from`, or anywhere with from = -1) along unit `direction`.
  /// A convex surface never hits itself, by identity; a ray that starts inside another sphere hits it at
  /// distance zero; a ray that meets the back of a wall is leaked, as is one that runs for ever along a
  /// periodic box. Thread-safe.
  /// `from_normal`: of wall `from` at the origin; without it a ray from a wall that is a plate of two sides
  /// meets the back of its own plate.
  Hit first_hit(const Vec3& origin, const Vec3& direction, std::int32_t from,
                const Vec3& from_normal = {}) const;
  /// What a ray would meet were each sphere alone in a convex room: every sphere on the way (but the one that it leaves or
  /// starts inside of) and the wall behind them.
  struct Crossed {
    std::vector<std::int32_t> spheres;  ///< in no order; of rays that start on walls alone
    std::int32_t wall = -1;             ///< surface number
  };
  /// first_hit in a convex room.
  Hit first_hit_and_crossed(const Vec3& origin, const Vec3& direction, std::int32_t from,
                            const Vec3& from_normal, Crossed& crossed) const;
  End first_end(const Vec3& origin, const Vec3& direction, std::int32_t from,
                const Vec3& from_normal = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad
