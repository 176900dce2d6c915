#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/facets.h"

namespace granrad {

/// One image of a sphere, in tracing units. Without periodic boundaries every sphere has one.
struct Ball {
  Vec3 centre;
  double radius;
};

/// An enclosure as rays meet it: moved to its centre and divided by the mean radius, so that single precision
/// resolves it wherever it lies; with the periodic images that reach into the box; walls as facets. Throws
/// InputError for numbers that are not finite, radii that are not positive or not below half a period, faces
/// that are bent or not convex.
struct TracingGeometry {
  explicit TracingGeometry(const Enclosure& enclosure);

  Vec3 to_units(const Vec3& p) const { return (p - centre_m) * (1 / unit_m); }
  Vec3 to_metres(const Vec3& p) const { return p * unit_m + centre_m; }
  /// The image of a sphere whose centre is here, or -1.
  std::int32_t image_at(std::int32_t sphere, const Vec3& centre) const;
  /// Whether a face hides `origin` from the centre of its sphere.
  bool hides(std::int32_t face, const Vec3& centre, const Vec3& origin) const;

  Vec3 centre_m;      ///< origin of the tracing coordinates
  double unit_m = 1;  ///< length of a tracing unit: the mean radius
  double pad = 0;     ///< what single precision can misplace a ray by, anywhere in the scene
  std::int32_t spheres, open;
  std::array<bool, 3> periodic;
  Vec3 box_min, box_max;
  Vec3 low{}, high{};  ///< bounds of all spheres and walls, padded

  std::int64_t most_periods = 0;  ///< a ray may cross: see count_periods

  std::vector<Ball> balls;  ///< the spheres in their order, then further periodic images
  std::vector<std::int32_t> sphere_of_ball;
  std::vector<std::int32_t> first_image;  ///< [spheres + 1], images of a sphere beyond itself; periodic only

  std::optional<Facets> cell_facets, loose_facets;
  std::optional<ConvexCell> cell;  ///< of cell_facets: nothing leaks, and no tree is needed
  std::vector<char> is_planar;     ///< by wall

 private:
  void choose_units(const Enclosure& enclosure);
  void count_periods(const Enclosure& enclosure);
  void add_balls(const Enclosure& enclosure);
  void add_facets(const Enclosure& enclosure);
};

}  // namespace granrad
