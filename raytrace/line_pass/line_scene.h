#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/line_pass/line_kernel.h"

namespace granrad {

class EmbreeTracer;
class WallPatches;

/// An enclosure made ready for parallel lines: checked, recentred on its middle, column by column. Spheres
/// are sorted so that neighbours in space are mostly neighbours in memory.
struct LineScene {
  struct Face {
    std::vector<Vec3> corners;
    Vec3 normal;  ///< inward
    std::int32_t surface;
    bool image = false;  ///< of a face of the box itself: lines enter through it, and are not counted there
  };

  std::vector<double> x, y, z, radius;  ///< m, from the middle
  std::vector<float> reach;             ///< radius / spacing
  std::vector<std::int32_t> surface;    ///< number of each sphere in the enclosure
  std::vector<Face> faces;
  std::vector<std::size_t> first_face;  ///< of each wall or patch
  std::vector<Vec3> hull;               ///< points whose hull holds everything a line may meet
  bool closed = false;                  ///< the faces meet edge to edge: no line escapes
  double spacing = 1;                   ///< m, between lines
  std::int32_t open_surface = 0;

  /// Periodic scenes (period > 0 in their directions; elsewhere walls close the box): line ends are counted
  /// in the box itself. What came before is looked for among images as far as upstream_m, and beyond them by
  /// `tracer`, ray by ray.
  Vec3 period{}, middle{};
  double upstream_m = 0;
  std::shared_ptr<const EmbreeTracer> tracer;

  bool is_periodic() const { return tracer != nullptr; }
  double room_for_images() const;  ///< spacings around the box that whole discs of images need
  std::size_t surface_count() const { return static_cast<std::size_t>(open_surface) + 1; }
  LineSpheres spheres() const;
  /// Values by surface number, taken to the order of this scene (walls and surroundings come last in both).
  template <class T>
  std::vector<T> sorted(const std::vector<T>& by_surface) const {
    std::vector<T> values = by_surface;
    for (std::size_t k = 0; k < surface.size(); ++k)
      values[k] = by_surface[static_cast<std::size_t>(surface[k])];
    return values;
  }
  /// The inverse.
  template <class T>
  std::vector<T> by_surface(const std::vector<T>& sorted) const {
    std::vector<T> values = sorted;
    for (std::size_t k = 0; k < surface.size(); ++k) values[static_cast<std::size_t>(surface[k])] = sorted[k];
    return values;
  }

  /// Spacing such that `lines_per_disc` lines meet a disc of the 10 % quantile of the radii (without spheres:
  /// the mean face is met by 4096 lines), but never more lines than 2^26 in one direction. Throws InputError
  /// with every problem found. `patches`: of the enclosure's walls, surfaces of their own in place of the walls.
  LineScene(const Enclosure& enclosure, double lines_per_disc, const WallPatches* patches = nullptr);

 private:
  void cut_faces(const WallPatches& patches);
  void add_periods(const Enclosure& enclosure);
};

}  // namespace granrad
