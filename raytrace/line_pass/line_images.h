#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/line_pass/line_lattice.h"

namespace granrad {

/// A sphere, m from the middle of the scene.
struct LineBall {
  Vec3 centre;
  double radius;
};

/// The spheres that the lines of one direction meet in a periodic scene: those of the box itself under their
/// surface numbers, and behind all surface numbers the images that lie upstream on lines through the box, as
/// far as LineScene::upstream_m. Reused from one direction to the next.
class LineImages {
 public:
  explicit LineImages(const LineScene& scene);

  /// Chooses the images for a direction whose lattice has been placed.
  LineSpheres choose(const LineFrame& frame, const LineLattice& lattice);

  bool is_image(std::int32_t id) const { return id > scene_.open_surface; }
  /// Surface number of a sphere or image, of walls unchanged.
  std::int32_t home(std::int32_t id) const { return is_image(id) ? scene_.surface[source_[index(id)]] : id; }
  LineBall ball(std::int32_t id) const {
    const auto k = index(id);
    return {{x_[k], y_[k], z_[k]}, scene_.radius[source_[k]]};
  }

 private:
  /// Place in the columns: the spheres of the scene in its order, then images.
  std::size_t index(std::int32_t id) const {
    return is_image(id) ? scene_.x.size() + static_cast<std::size_t>(id - scene_.open_surface - 1)
                        : static_cast<std::size_t>(place_[static_cast<std::size_t>(id)]);
  }
  void add_images(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice);
  bool reaches(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice) const;

  const LineScene& scene_;
  std::vector<std::int32_t> place_;  ///< in the scene, by surface number
  std::vector<double> x_, y_, z_;
  std::vector<float> reach_;
  std::vector<std::int32_t> id_;
  std::vector<std::size_t> source_;  ///< sphere of the scene
};

}  // namespace granrad
