#include "dem/feed/columns.h"

#include <algorithm>
#include <cmath>

namespace granrad {

Columns::Columns(const Bed& bed, const Box& region, double radius_m)
    : bottom_m_(region.min.z), radius_m_(radius_m) {
  double largest = radius_m;
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (wrapped_into_box(bed, bed.position_m[i]).z <= bottom_m_ - bed.radius_m[i]) continue;
    largest = std::max(largest, bed.radius_m[i]);
    there.push_back(i);
  }
  width_m_ = radius_m + largest;  // spheres that touch stand in neighbouring columns
  for (const std::size_t i : there) add(bed, i);
}

std::int64_t Columns::key(double x, double y) const {
  return static_cast<std::int64_t>(std::floor(x / width_m_)) * (std::int64_t{1} << 32) +
         static_cast<std::int64_t>(std::floor(y / width_m_));
}

/// A sphere near a period's end stands in the columns of its images as well.
void Columns::add(const Bed& bed, std::size_t particle) {
  const Vec3 place = wrapped_into_box(bed, bed.position_m[particle]), period = bed.box.size();
  for (int i = bed.periodic[0] ? -1 : 0; i <= (bed.periodic[0] ? 1 : 0); ++i)
    for (int j = bed.periodic[1] ? -1 : 0; j <= (bed.periodic[1] ? 1 : 0); ++j)
      columns_[key(place.x + i * period.x, place.y + j * period.y)].push_back(particle);
}

double Columns::floor_m(const Bed& bed, double x, double y) const {
  double floor = bottom_m_ + radius_m_;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const auto found = columns_.find(key(x + i * width_m_, y + j * width_m_));
      if (found == columns_.end()) continue;
      for (const std::size_t other : found->second) {
        const Vec3 place = wrapped_into_box(bed, bed.position_m[other]);
        const Vec3 apart = nearest_image(bed, {place.x - x, place.y - y, 0});
        const double touching = radius_m_ + bed.radius_m[other];
        const double below = touching * touching - apart.x * apart.x - apart.y * apart.y;
        if (below > 0) floor = std::max(floor, place.z + std::sqrt(below));
      }
    }
  return floor;
}

}  // namespace granrad
