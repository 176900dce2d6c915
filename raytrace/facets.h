#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Where a ray crosses a wall.
struct FacetHit {
  double distance;
  std::int32_t facet;  ///< -1: none
};

/// The faces of walls, tested in double precision.
/// Edges are widened by `tolerance` for rays that arrive from the front, so that none slips between two
/// pieces that share an edge, and narrowed by it for rays that arrive from behind, so that a sharp edge
/// does not report its own back. The unit of length is the caller's.
class Facets {
 public:
  explicit Facets(double tolerance) : tolerance_(tolerance) {}

  /// Adds the pieces of `walls[wall]`, moved by -origin and multiplied by `scale`. Throws InputError for a
  /// polygon that is not planar and convex, or has no area.
  void add(const Wall& wall, std::int32_t number, const Vec3& origin, double scale);

  std::int32_t count() const { return static_cast<std::int32_t>(normal_.size()); }
  double tolerance() const { return tolerance_; }
  const Vec3& normal(std::int32_t facet) const { return normal_[facet]; }
  double offset(std::int32_t facet) const { return offset_[facet]; }
  double area(std::int32_t facet) const { return area_[facet]; }
  std::int32_t wall(std::int32_t facet) const { return wall_[facet]; }
  const std::vector<Vec3>& vertices(std::int32_t facet) const { return vertices_[facet]; }
  /// Height of a point above the plane, positive on the radiating side.
  double height(std::int32_t facet, const Vec3& p) const { return dot(normal_[facet], p) - offset_[facet]; }
  /// Smallest distance of a point of the plane to the edges, positive inside.
  double edge_margin(std::int32_t facet, const Vec3& p) const;

  /// Distance at which the ray meets the front of the facet, at least 0; infinite when it does not.
  double front_crossing(std::int32_t facet, const Vec3& origin, const Vec3& direction) const;
  /// Distance at which it meets the back.
  double back_crossing(std::int32_t facet, const Vec3& origin, const Vec3& direction) const;

  /// Volume enclosed by all pieces (divergence theorem), or nothing when they do not close the directions
  /// that are not periodic: their vector areas do not cancel there. Of one period, not for all three
  /// periodic.
  std::optional<double> enclosed_volume(const std::array<bool, 3>& periodic) const;

 private:
  double moment(std::int32_t facet, int axis) const;
  void add_piece(std::vector<Vec3> vertices, std::int32_t wall);
  void refuse_bent(const std::string& name, std::int32_t facet) const;

  struct Edge {
    Vec3 inward;  ///< unit, in the plane
    double offset;
  };
  double tolerance_;
  std::vector<Vec3> normal_;
  std::vector<double> offset_, area_;
  std::vector<std::int32_t> wall_, edge_begin_{0};
  std::vector<Edge> edges_;
  std::vector<std::vector<Vec3>> vertices_;
};

/// The inside of facets that together are the whole boundary of a convex polyhedron. Every ray that starts
/// inside leaves through exactly one of them, whatever the rounding: there is nothing to leak through.
class ConvexCell {
 public:
  /// Nothing when the facets are not convex or leave a hole.
  static std::optional<ConvexCell> from(const Facets& facets);

  /// Exit of a ray; a start more than the tolerance behind a plane is on that plane, at distance 0.
  /// `facets` are those the cell was made from.
  FacetHit exit(const Facets& facets, const Vec3& origin, const Vec3& direction) const;

  struct Plane {
    Vec3 normal;  ///< inward
    double offset;
  };
  const std::vector<Plane>& planes() const { return planes_; }
  /// The facets of a plane.
  const std::vector<std::int32_t>& facets_of(std::size_t plane) const { return faces_[plane]; }

 private:
  std::vector<Plane> planes_;
  std::vector<std::vector<std::int32_t>> faces_;  ///< facets of each plane
};

}  // namespace granrad
