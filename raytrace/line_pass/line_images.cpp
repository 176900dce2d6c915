#include "raytrace/line_pass/line_images.h"

#include <algorithm>
#include <cmath>

namespace granrad {

LineImages::LineImages(const LineScene& scene)
    : scene_(scene), x_(scene.x), y_(scene.y), z_(scene.z), reach_(scene.reach), id_(scene.surface) {
  place_.resize(scene.surface.size());
  for (std::size_t k = 0; k < place_.size(); ++k) {
    place_[static_cast<std::size_t>(scene.surface[k])] = static_cast<std::int32_t>(k);
    source_.push_back(k);
  }
}

/// Whether an image of the box, moved by `shift`, may hold spheres on the lines and before the box.
bool LineImages::reaches(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice) const {
  const double per_m = 1 / scene_.spacing, reach = scene_.spheres().max_reach;
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
  for (const Vec3& corner : scene_.hull) {
    const Vec3 p = corner + shift;
    const double at[3] = {dot(p, frame.u) * per_m - lattice.origin_u,
                          dot(p, frame.v) * per_m - lattice.origin_v, dot(p, frame.w) * per_m};
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
  }
  return high[0] > -reach && low[0] < lattice.columns + reach && high[1] > -reach &&
         low[1] < lattice.rows + reach && high[2] > lattice.depth && low[2] < lattice.depth_end;
}

void LineImages::add_images(const Vec3& shift, const LineFrame& frame, const LineLattice& lattice) {
  const double per_m = 1 / scene_.spacing;
  const double su = dot(shift, frame.u), sv = dot(shift, frame.v), sw = dot(shift, frame.w);
  for (std::size_t i = 0; i < scene_.x.size(); ++i) {
    const Vec3 c{scene_.x[i], scene_.y[i], scene_.z[i]};
    const double u = (dot(c, frame.u) + su) * per_m - lattice.origin_u,
                 v = (dot(c, frame.v) + sv) * per_m - lattice.origin_v, w = (dot(c, frame.w) + sw) * per_m,
                 reach = scene_.reach[i];
    // The lattice has room for whole discs around every cell that a line through the box may take.
    if (u < reach + 1 || v < reach + 1 || u > lattice.columns - reach - 2 || v > lattice.rows - reach - 2)
      continue;
    if (w < lattice.depth || w > lattice.depth_end) continue;
    const Vec3 p = c + shift;
    x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    reach_.push_back(scene_.reach[i]);
    id_.push_back(scene_.open_surface + 1 + static_cast<std::int32_t>(source_.size() - scene_.x.size()));
    source_.push_back(i);
  }
}

LineSpheres LineImages::choose(const LineFrame& frame, const LineLattice& lattice) {
  const std::size_t own = scene_.x.size();
  x_.resize(own), y_.resize(own), z_.resize(own), reach_.resize(own), id_.resize(own), source_.resize(own);
  int low[3] = {}, high[3] = {};
  for (int k = 0; k < 3; ++k) {
    if (!(scene_.period[k] > 0)) continue;
    const double offset = -scene_.upstream_m * frame.w[k] / scene_.period[k];
    low[k] = static_cast<int>(std::floor(std::min(0.0, offset))) - 1;
    high[k] = static_cast<int>(std::ceil(std::max(0.0, offset))) + 1;
  }
  for (int a = low[0]; a <= high[0]; ++a)
    for (int b = low[1]; b <= high[1]; ++b)
      for (int c = low[2]; c <= high[2]; ++c) {
        const Vec3 shift{a * scene_.period.x, b * scene_.period.y, c * scene_.period.z};
        if ((a || b || c) && reaches(shift, frame, lattice)) add_images(shift, frame, lattice);
      }
  return {static_cast<std::int32_t>(x_.size()),
          x_.data(),
          y_.data(),
          z_.data(),
          reach_.data(),
          id_.data(),
          scene_.spheres().max_reach};
}

}  // namespace granrad
