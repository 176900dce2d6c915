#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/line_lattice.h"

namespace granrad {

/// The spheres that the lines of one direction meet in a periodic scene: those of the box itself under their
/// surface numbers, and behind all surface numbers the images that lie upstream on lines through the box, as
/// far as LineScene::upstream_m. Reused from one direction to the next.
class LineImages {
 public:
  explicit LineImages(const LineScene& scene);

  /// Chooses the images for a direction whose lattice has been placed.
  LineSpheres choose(const LineFrame& frame, const LineLattice& lattice);

  bool is_image(std::int32_t id) const { return id >= scene_.open_surface + 1; }
  /// Surface number of a sphere or image, of walls unchanged.
  std::int32_t home(std::int32_t id) const { return is_image(id) ? home_[id] : id; }
  Vec3 centre(std::int32_t id) const { return {x_[id], y_[id], z_[id]}; }

 private:
  void add_images(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice);
  bool reaches(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice) const;

  const LineScene& scene_;
  std::vector<double> x_, y_, z_;
  std::vector<float> reach_;
  std::vector<std::int32_t> home_;
};

}  // namespace granrad
