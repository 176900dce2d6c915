#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/base/aligned.h"
#include "dem/bed/wall.h"

namespace granrad {

/// All walls as one surface of convex planar facets (polygons and triangles) that know their neighbours:
/// vertices at equal positions are one vertex, sides between equal vertices one edge, whatever wall they
/// belong to. Facets joined through coplanar edges form a group, which acts as one plane. A facet with the
/// corners of an earlier one is its twin (the other side of a plate): the earlier stands for both.
///
/// A sphere touches the surface where the distance from its centre has a local minimum: inside a facet, on an
/// edge, or at a vertex. Tested with the signs of the same numbers from both sides, so a contact is found
/// once however the surface is cut into facets.
///
/// Features are numbered groups (by their lowest facet), then edges, then vertices; the numbers depend on the
/// walls only and key the memory of contacts.
class WallSurface {
 public:
  explicit WallSurface(const std::vector<Wall>& walls);

  /// What has a local minimum of the distance; of two that report one place, the earlier here counts.
  enum class Kind { face, edge, vertex };
  struct Touch {
    std::int64_t feature;
    std::int32_t facet;  ///< one that has the feature
    Kind kind;
    Vec3 point;
    Vec3 normal;  ///< from the surface to the centre
    double distance_m;
  };
  /// What facet `f` contributes at point p: its face, edges and vertices that are local minima closer than
  /// `reach_m`. Edges and vertices shared by several facets are reported by each of them.
  void touches(std::int32_t f, const Vec3& p, double reach_m, std::vector<Touch>& out) const;

  /// The distinct places where a sphere of this radius around p is closer than `reach_m` to facets of an
  /// ascending list: of touches that report the same wall, the one of lower rank (face, edge, vertex), then
  /// the nearer, stays. Faces first. Where rounding leaves a crack between features the nearest side closes
  /// it.
  std::vector<Touch> distinct_touches(const std::int32_t* begin, const std::int32_t* end, const Vec3& p,
                                      double reach_m, double radius_m) const;
  /// As distinct_touches, of touches that were found already.
  std::vector<Touch> distinct(std::vector<Touch> all, double radius_m) const;
  /// The wall a touch belongs to: of facets of `begin` to `end` back to back, the one that faces p.
  std::int32_t wall_facing(const Touch& touch, const Vec3& p, const std::int32_t* begin,
                           const std::int32_t* end) const;

  /// The nearest point of the sides of facet f.
  Touch nearest(std::int32_t f, const Vec3& p) const;

  /// Which facets stand: their walls take part in contact and are not yet opened.
  void set_time(const std::vector<Wall>& walls, double time_s);

  std::int32_t facet_count() const { return static_cast<std::int32_t>(facets_.size()); }
  /// Facets are the faces of all walls in their order: none was left out for having no area.
  bool is_whole() const { return whole_; }
  bool stands(std::int32_t f) const { return facets_[f].stands; }
  /// Unit normal of the plane of the facet's group.
  const Vec3& plane_normal(std::int32_t f) const { return facets_[facets_[f].group].normal; }
  /// Whether two facets lie in one plane, whatever way they face.
  bool in_one_plane(std::int32_t f, std::int32_t g) const { return coplanar(facets_[f], facets_[g]); }
  std::int32_t group(std::int32_t f) const { return facets_[f].group; }
  std::int32_t wall(std::int32_t f) const { return facets_[f].wall; }
  const Box& bounds(std::int32_t f) const { return facets_[f].bounds; }
  /// Signed distance from the plane of the facet's group.
  double height(std::int32_t f, const Vec3& p) const;
  bool foot_inside(std::int32_t f, const Vec3& p) const;
  /// Distance from p to the facet.
  double distance(std::int32_t f, const Vec3& p) const;
  /// True if the foot of p on the plane is further than `margin_m` from every side of the facet that is not
  /// coplanar with its neighbour: where the foot is inside the group, the group touches p as a plane until p
  /// has moved by that much.
  bool clear_of_sides(std::int32_t f, const Vec3& p, double margin_m) const;
  /// Whether two features meet (a group and its edge, an edge and its end), or are groups that share an edge.
  bool adjacent(std::int64_t a, std::int64_t b) const;

  /// Planes by facet, as the kernels read them (rows of the facet's group); one more that nobody touches pads
  /// lists.
  const double* plane_rows() const { return plane_rows_.data(); }
  const double* velocity_rows() const { return velocity_rows_.data(); }
  Vec3 velocity(std::int32_t f) const {
    return {velocity_rows_[4 * f], velocity_rows_[4 * f + 1], velocity_rows_[4 * f + 2]};
  }

 private:
  struct Side {  ///< from corner k to corner k + 1 of a facet
    std::int32_t edge;
    Vec3 inward;          ///< unit vector in the facet's plane
    bool smooth = false;  ///< the neighbour is coplanar; its inward vector is exactly the opposite
  };
  struct Facet {
    std::int32_t wall, group;
    std::vector<std::int32_t> corners;
    std::vector<Side> sides;
    Vec3 point, normal;
    Box bounds;
    bool twin = false, stands = true;
    std::int32_t back = -1;  ///< its twin that faces the other way
  };
  struct Edge {
    std::int32_t ends[2];
    Vec3 start, direction;  ///< unit vector from ends[0] to ends[1]
    double length;
    std::vector<std::int32_t> facets;
    double along(const Vec3& p) const { return dot(p - start, direction); }
  };
  double inside_by(const Side& side, const Vec3& p) const {
    return dot(p - edges_[side.edge].start, side.inward);
  }
  Side& side_of(std::int32_t facet, std::int32_t edge);
  const Side& side_of(std::int32_t facet, std::int32_t edge) const;
  void add_facet(std::int32_t wall, const std::vector<Vec3>& corners);
  void find_twins(const std::vector<Wall>& walls);
  void split_sides();
  void join_sides();
  bool repeats(const Touch& t, const Touch& kept, double tolerance_m) const;
  void group_coplanar(const std::vector<Wall>& walls);
  void fill_rows(const std::vector<Wall>& walls);
  bool coplanar(const Facet& a, const Facet& b) const;
  bool edge_is_minimum(std::int32_t edge, const Vec3& p) const;
  bool vertex_is_minimum(std::int32_t vertex, const Vec3& p) const;
  bool vertex_in_group(std::int32_t vertex, std::int32_t group) const;
  std::int64_t edge_feature(std::int32_t e) const { return facet_count() + e; }
  std::int64_t vertex_feature(std::int32_t v) const {
    return facet_count() + static_cast<std::int64_t>(edges_.size()) + v;
  }

  std::vector<Facet> facets_;
  std::vector<Edge> edges_;
  std::vector<Vec3> vertices_;
  std::vector<std::vector<std::int32_t>> edges_of_vertex_;
  std::vector<bool> vertex_is_flat_;  ///< all facets around it are one group
  AlignedVector<double> plane_rows_, velocity_rows_;
  bool whole_ = true;
};

}  // namespace granrad
