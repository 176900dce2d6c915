#include "fit/correlation/solid_fraction_field.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/solid_fraction.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/running_sums.h"
#include "raytrace/facets.h"

namespace granrad {

namespace {

constexpr double spheres_in_window = 100, least_window = 5;  ///< window: spheres, and width in d
constexpr double uniform_below = 0.15, local_from = 0.30;    ///< rms deviation over the spheres
constexpr double most_cells = 4e6;

Box bounds(const Enclosure& enclosure) {
  Box box = Box::empty();
  for (const Wall& wall : enclosure.walls)
    for (const Vec3& v : wall.vertices) box.include(v);
  return box;
}

/// Every corner of every wall on the inner side of every other.
bool is_convex(const Enclosure& enclosure, const Box& box) {
  const double tolerance = 1e-6 * norm(box.size());
  for (const Wall& wall : enclosure.walls) {
    const auto plane = plane_of(wall);
    if (!plane) return false;
    for (const Wall& other : enclosure.walls)
      for (const Vec3& v : other.vertices)
        if (plane->height(v) < -tolerance) return false;
  }
  return enclosure.walls.size() >= 4;
}

}  // namespace

double solid_fraction(const Enclosure& enclosure) {
  if (enclosure.solid_fraction > 0) return enclosure.solid_fraction;
  Facets facets(0);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), {}, 1);
  const auto volume = facets.enclosed_volume({});
  if (!volume || !(*volume > 0))
    throw InputError(
        advised("the walls do not enclose a volume (the solid fraction of the bed cannot be measured)",
                "close the box with walls, or give a [region]"));
  double solid = 0;
  for (const double r : enclosure.radius_m) solid += sphere_volume(r);
  return solid / *volume;
}

SolidFractionField::SolidFractionField(const Enclosure& enclosure, double whole)
    : whole_(whole), mean_(whole), largest_(whole), box_(bounds(enclosure)) {
  if (enclosure.sphere_count() < 2 || !(whole > 0) || !is_convex(enclosure, box_)) return;
  double diameter_m = 0;
  for (const double r : enclosure.radius_m)
    diameter_m += 2 * r / static_cast<double>(enclosure.sphere_count());
  choose_cells(std::max(diameter_m, std::cbrt(box_.volume() / most_cells)));
  for (int k = 0; k < 3; ++k) cell_m_[k] = box_.size()[k] / count_[k];
  std::vector<double> solid(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2], 0.0);
  share_out(enclosure, solid);
  const double window_m = diameter_m * std::max(least_window, std::cbrt(spheres_in_window * pi / 6 / whole));
  average(solid, free_parts(enclosure), window_m);
  measure(enclosure);
}

/// Flat boxes are one cell thick, and would else have more than the most.
void SolidFractionField::choose_cells(double edge_m) {
  double all = 0;
  do {
    all = 1;
    for (int k = 0; k < 3; ++k) {
      count_[k] = static_cast<int>(std::clamp(box_.size()[k] / edge_m, 1.0, most_cells));
      all *= count_[k];
    }
    edge_m *= 1.25;
  } while (all > 1.01 * most_cells);
}

std::size_t SolidFractionField::cell_of(const Vec3& place_m) const {
  std::array<std::size_t, 3> c;
  for (int k = 0; k < 3; ++k)
    c[k] =
        static_cast<std::size_t>(std::clamp((place_m[k] - box_.min[k]) / cell_m_[k], 0.0, count_[k] - 1.0));
  return (c[2] * count_[1] + c[1]) * count_[0] + c[0];
}

/// Each sphere as a cube of its volume.
void SolidFractionField::share_out(const Enclosure& enclosure, std::vector<double>& solid) const {
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const double half = 0.5 * std::cbrt(sphere_volume(enclosure.radius_m[i]));
    std::array<int, 3> first, last;
    for (int k = 0; k < 3; ++k) {
      const double at = enclosure.centre_m[i][k] - box_.min[k];
      first[k] = std::clamp(static_cast<int>((at - half) / cell_m_[k]), 0, count_[k] - 1);
      last[k] = std::clamp(static_cast<int>((at + half) / cell_m_[k]), 0, count_[k] - 1);
    }
    const auto shared = [&](int axis, int cell) {
      const double at = enclosure.centre_m[i][axis] - box_.min[axis];
      return std::max(
          0.0, std::min(at + half, (cell + 1) * cell_m_[axis]) - std::max(at - half, cell * cell_m_[axis]));
    };
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x)
          solid[(static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x] +=
              shared(0, x) * shared(1, y) * shared(2, z);
  }
}

/// Volume of each cell inside the walls, by 27 points.
std::vector<double> SolidFractionField::free_parts(const Enclosure& enclosure) const {
  std::vector<Vec3> normal;
  for (const Wall& wall : enclosure.walls) normal.push_back(plane_of(wall)->normal);
  const auto inside = [&](const Vec3& p) {
    for (std::size_t w = 0; w < normal.size(); ++w)
      if (dot(normal[w], p - enclosure.walls[w].vertices[0]) < 0) return false;
    return true;
  };
  const double point_volume = cell_m_.x * cell_m_.y * cell_m_.z / 27;
  std::vector<double> space;
  for (int z = 0; z < count_[2]; ++z)
    for (int y = 0; y < count_[1]; ++y)
      for (int x = 0; x < count_[0]; ++x) {
        int points = 0;
        for (int k = 0; k < 27; ++k) {
          const int a = k % 3, b = k / 3 % 3, c = k / 9;
          points += inside(box_.min + Vec3{cell_m_.x * (x + (a + 0.5) / 3), cell_m_.y * (y + (b + 0.5) / 3),
                                           cell_m_.z * (z + (c + 0.5) / 3)});
        }
        space.push_back(points * point_volume);
      }
  return space;
}

void SolidFractionField::average(const std::vector<double>& solid, const std::vector<double>& space,
                                 double width_m) {
  const RunningSums solids(solid, count_), spaces(space, count_);
  std::array<int, 3> reach;
  for (int k = 0; k < 3; ++k)
    reach[k] = std::max(1, static_cast<int>(std::lround(0.5 * (width_m / cell_m_[k] - 1))));
  value_.clear();
  for (int z = 0; z < count_[2]; ++z)
    for (int y = 0; y < count_[1]; ++y)
      for (int x = 0; x < count_[0]; ++x) {
        const std::array<int, 3> at{x, y, z};
        std::array<int, 3> low, high;
        for (int k = 0; k < 3; ++k)
          low[k] = std::max(0, at[k] - reach[k]), high[k] = std::min(count_[k], at[k] + reach[k] + 1);
        const double volume = spaces.over(low, high);
        value_.push_back(volume > 0 ? solids.over(low, high) / volume : 0);
      }
}

void SolidFractionField::measure(const Enclosure& enclosure) {
  double sum2 = 0, sum = 0;
  for (const Vec3& c : enclosure.centre_m) {
    const double excess = value_[cell_of(c)] / whole_ - 1;
    sum2 += excess * excess;
    sum += excess;
  }
  const double n = static_cast<double>(enclosure.sphere_count());
  deviation_ = std::sqrt(sum2 / n);
  local_share_ = std::clamp((deviation_ - uniform_below) / (local_from - uniform_below), 0.0, 1.0);
  mean_ = whole_ * (1 + local_share_ * sum / n);
  for (double& v : value_) v = whole_ + local_share_ * (v - whole_);
  for (const Vec3& c : enclosure.centre_m) largest_ = std::max(largest_, at(c));
}

double SolidFractionField::between(const Vec3& from_m, const Vec3& to_m) const {
  if (uniform()) return whole_;
  const double length = norm(to_m - from_m), step = 2 * std::min({cell_m_.x, cell_m_.y, cell_m_.z});
  const int parts = std::clamp(static_cast<int>(std::ceil(length / step)), 1, 32);
  double sum = 0;
  for (int k = 0; k < parts; ++k) sum += at(from_m + (to_m - from_m) * ((k + 0.5) / parts));
  return sum / parts;
}

}  // namespace granrad
