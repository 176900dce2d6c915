#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/enclosure.h"
#include "raytrace/facets.h"

namespace granrad {

/// An enclosure without its spheres: which wall a line ends on where no sphere stands, and what of a sphere's rays each
/// wall would get.
class EmptyRoom {
 public:
  /// Of the enclosure's walls. A closed convex room of planar walls is answered by its planes, any other by Embree.
  EmptyRoom(const Enclosure& enclosure, int threads);

  std::size_t walls() const { return walls_.walls.size(); }
  /// Whether no wall hides another or stands between two spheres.
  bool convex() const { return cell_.has_value() || walls_.walls.empty(); }
  /// The inside of a convex room; nothing in any other.
  const std::optional<ConvexCell>& cell() const { return cell_; }
  /// The wall that is a plane of the cell; -1: there are several.
  std::int32_t only_wall(std::size_t plane) const {
    return cell_->facets_of(plane).size() == 1 ? facets_.wall(cell_->facets_of(plane)[0]) : -1;
  }
  /// Where a line from a point inside ends.
  struct End {
    std::int32_t wall;  ///< -1: it leaves
    double distance_m;
  };
  End end(const Vec3& origin, const Vec3& direction) const;

  /// View factors of spheres to walls, [sphere][wall], with the variance of each (0: exact).
  struct Factors {
    std::vector<double> value, variance;
  };
  /// Exact in a convex room (exact_sphere_wall), by 2048 Sobol rays a sphere in any other, variances pooled over the
  /// replicates of all spheres.
  Factors factors(const Enclosure& enclosure, std::uint64_t seed, int threads) const;

 private:
  Factors traced_factors(const Enclosure& enclosure, std::uint64_t seed, int threads) const;

  Enclosure walls_;
  Facets facets_;
  std::optional<ConvexCell> cell_;
  std::optional<EmbreeTracer> tracer_;
};

}  // namespace granrad
