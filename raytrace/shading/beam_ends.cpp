#include "raytrace/shading/beam_ends.h"

#include <algorithm>
#include <limits>

namespace granrad {

void BeamEnds::find(const Beam& beam, const ConvexCell& room) {
  const std::size_t count = beam.lines.count();
  constexpr float far = std::numeric_limits<float>::max();
  std::fill_n(ahead_at_.begin(), count, far);
  std::fill_n(behind_at_.begin(), count, far);
  std::int32_t number = 0;
  for (const auto& plane : room.planes()) {
    const auto along = [&](int axis) { return static_cast<float>(dot(plane.normal, beam.axes[axis])); };
    const double height = (dot(plane.normal, beam.centre_m) - plane.offset) / beam.diameter_m;
    meet(beam.lines, number++, along(0), along(1), along(2), static_cast<float>(height));
  }
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void BeamEnds::meet(const BeamLines::Set& lines, std::int32_t number, float nx, float ny, float nz, float height) {
  const std::size_t count = lines.count();
  const float *px = lines.point_x.data(), *py = lines.point_y.data(), *pz = lines.point_z.data(),
              *dx = lines.direction_x.data(), *dy = lines.direction_y.data(), *dz = lines.direction_z.data();
  constexpr float far = std::numeric_limits<float>::max();
  for (std::size_t k = 0; k < count; ++k) {
    const float above = height + nx * px[k] + ny * py[k] + nz * pz[k];
    const float rise = nx * dx[k] + ny * dy[k] + nz * dz[k];
    const float h = above > 0 ? above : 0.0f, at = h / rise;
    const float in_front = rise < 0 ? -at : far, at_back = rise > 0 ? at : far;
    const bool nearer = in_front < ahead_at_[k], nearer_back = at_back < behind_at_[k];
    ahead_at_[k] = nearer ? in_front : ahead_at_[k];
    ahead_[k] = nearer ? number : ahead_[k];
    behind_at_[k] = nearer_back ? at_back : behind_at_[k];
    behind_[k] = nearer_back ? number : behind_[k];
  }
}

}  // namespace granrad
