#include "dem/cover/laid_plates.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

class Plates {
 public:
  Plates(std::vector<Wall>& walls, double slack_m) : walls_(walls), slack_m_(slack_m) {
    for (const auto& wall : walls_)
      planes_.push_back(wall.vertices.size() >= 3 ? plane_of(wall) : std::nullopt);
  }

  LaidPlates lay(const std::vector<std::size_t>& by_age) {
    LaidPlates laid{std::vector<char>(walls_.size(), 0), {}};
    for (std::size_t k = 1; k < by_age.size(); ++k)
      for (std::size_t m = 0; m < k; ++m)
        if (lies_in(by_age[k], by_age[m])) {
          const std::size_t plate = by_age[k];
          laid.is_foot[plate] = is_foot(by_age[m], plate);
          if (lay_on(by_age[m], plate, laid.is_foot[plate]))
            laid.notes.push_back(fmt::format("wall {} faced out of wall {} on which it lies, and was turned",
                                             walls_[plate].name, walls_[by_age[m]].name));
          break;
        }
    return laid;
  }

 private:
  bool lies_in(std::size_t later, std::size_t earlier) const {
    if (!planes_[later] || !planes_[earlier]) return false;
    if (std::abs(dot(planes_[later]->normal, planes_[earlier]->normal)) < nearly_parallel) return false;
    const auto& v = walls_[later].vertices;
    return std::all_of(v.begin(), v.end(),
                       [&](const Vec3& p) { return std::abs(planes_[earlier]->height(p)) <= slack_m_; });
  }

  /// Whether all walls stand on the front side of a plane, and not all in it.
  bool is_outermost(const WallPlane& plane) const {
    double highest = 0;
    for (const auto& wall : walls_)
      for (const auto& p : wall.vertices) {
        if (plane.height(p) < -slack_m_) return false;
        highest = std::max(highest, plane.height(p));
      }
    return highest > slack_m_;
  }

  /// Whether a plate that faces out of the plane it lies in is what a body stands on: along every edge another plate
  /// rises that faces away from it.
  bool is_foot(std::size_t ground, std::size_t plate) const {
    const Vec3 up = planes_[ground]->normal;
    if (dot(up, planes_[plate]->normal) > 0) return false;
    const auto& v = walls_[plate].vertices;
    for (std::size_t k = 0; k < v.size(); ++k) {
      const Vec3 from = v[k], to = v[(k + 1) % v.size()];
      const Vec3 outward = cross(to - from, planes_[plate]->normal);
      bool rises = false;
      for (std::size_t w = 0; w < walls_.size() && !rises; ++w)
        rises = w != plate && planes_[w] && std::abs(dot(planes_[w]->normal, up)) < nearly_parallel &&
                dot(planes_[w]->normal, outward) > 0 && has_edge(walls_[w], from, to);
      if (!rises) return false;
    }
    return true;
  }

  bool has_edge(const Wall& wall, const Vec3& a, const Vec3& b) const {
    const auto& v = wall.vertices;
    const auto is = [&](const Vec3& p, const Vec3& q) { return norm(p - q) <= slack_m_; };
    for (std::size_t k = 0; k < v.size(); ++k) {
      const Vec3 &from = v[k], &to = v[(k + 1) % v.size()];
      if ((is(from, a) && is(to, b)) || (is(from, b) && is(to, a))) return true;
    }
    return false;
  }

  /// Whether the later one was turned.
  bool lay_on(std::size_t earlier, std::size_t later, bool stands) {
    const WallPlane plane = *planes_[earlier];
    bool turned = false;
    if (dot(plane.normal, planes_[later]->normal) < 0) {
      if (!stands && !is_outermost(plane)) return false;
      if (!stands) flip(walls_[later]);
      turned = !stands;
    }
    for (auto& p : walls_[later].vertices) p -= plane.height(p) * plane.normal;
    planes_[later] = stands ? WallPlane{plane.point, -1 * plane.normal} : plane;
    return turned;
  }

  std::vector<Wall>& walls_;
  double slack_m_;
  std::vector<std::optional<WallPlane>> planes_;
};

}  // namespace

LaidPlates lay_plates(std::vector<Wall>& walls, const std::vector<std::size_t>& by_age, double slack_m) {
  return Plates(walls, slack_m).lay(by_age);
}

}  // namespace granrad
