#include "dem/bed/planar_cut.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace granrad {

namespace {

using Polygon = std::vector<Vec3>;

bool is_thin(const Polygon& polygon, double thin_m) {
  if (polygon.size() < 3) return true;
  double longest = 0;
  for (const auto& v : polygon) longest = std::max(longest, norm(v - polygon[0]));
  return !(polygon_area(polygon) > thin_m * longest);
}

/// Where the edge from a to b, at heights ha and hb of opposite sign, crosses zero: the same bits from either
/// end.
Vec3 crossing(Vec3 a, Vec3 b, double ha, double hb) {
  if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b), std::swap(ha, hb);
  return a + (b - a) * (ha / (ha - hb));
}

struct Parts {
  Polygon inside, outside;
};

/// The parts of a polygon on both sides of the line through `start` with the unit vector `inward` across it.
Parts split(const Polygon& polygon, const Vec3& start, const Vec3& inward, double slack_m) {
  std::vector<double> height;
  for (const auto& v : polygon) {
    const double h = dot(inward, v - start);
    height.push_back(std::abs(h) <= slack_m ? 0 : h);
  }
  Parts parts;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const std::size_t next = (k + 1) % polygon.size();
    if (height[k] >= 0) parts.inside.push_back(polygon[k]);
    if (height[k] <= 0) parts.outside.push_back(polygon[k]);
    if (height[k] * height[next] >= 0) continue;
    const Vec3 p = crossing(polygon[k], polygon[next], height[k], height[next]);
    parts.inside.push_back(p);
    parts.outside.push_back(p);
  }
  return parts;
}

}  // namespace

std::vector<Polygon> difference(const Polygon& polygon, const WallFace& face, const Vec3& normal,
                                double slack_m, double thin_m) {
  Polygon corners = face.vertices;
  if (dot(face.normal, normal) < 0) std::reverse(corners.begin(), corners.end());
  Polygon rest = polygon;
  std::vector<Polygon> outside;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 edge = corners[(k + 1) % corners.size()] - corners[k];
    if (norm(edge) <= slack_m) continue;
    Parts parts = split(rest, corners[k], normalized(cross(normal, edge)), slack_m);
    if (!is_thin(parts.outside, thin_m)) outside.push_back(std::move(parts.outside));
    rest = std::move(parts.inside);
    if (is_thin(rest, thin_m)) return {polygon};
  }
  return outside;
}

Vec3 CornerSet::add(const Vec3& p) {
  const auto same =
      std::find_if(corners_.begin(), corners_.end(), [&](const Vec3& q) { return norm(p - q) <= slack_m_; });
  if (same != corners_.end()) return *same;
  corners_.push_back(p);
  return p;
}

void CornerSet::sort() {
  std::sort(corners_.begin(), corners_.end(),
            [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
}

bool CornerSet::insert_into(Polygon& polygon, const std::function<bool(const Vec3&)>& wanted) const {
  Polygon all;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    all.push_back(a);
    const double length = norm(b - a);
    if (!(length > 2 * slack_m_)) continue;
    const Vec3 along = (b - a) * (1 / length);
    std::vector<std::pair<double, Vec3>> found;
    const double low = std::min(a.x, b.x) - slack_m_, high = std::max(a.x, b.x) + slack_m_;
    auto p = std::lower_bound(corners_.begin(), corners_.end(), low,
                              [](const Vec3& v, double x) { return v.x < x; });
    for (; p != corners_.end() && p->x <= high; ++p) {
      const double t = dot(*p - a, along);
      if (t > slack_m_ && t < length - slack_m_ && norm(*p - a - along * t) <= slack_m_ &&
          (!wanted || wanted(*p)))
        found.emplace_back(t, *p);
    }
    std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    for (const auto& [t, corner] : found) all.push_back(corner);
  }
  const bool grown = all.size() > polygon.size();
  if (grown) polygon = std::move(all);
  return grown;
}

Polygon part_above(const Polygon& polygon, const Vec3& normal, double offset) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double ha = dot(normal, a) - offset, hb = dot(normal, b) - offset;
    if (ha >= 0) kept.push_back(a);
    if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) kept.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  return kept;
}

}  // namespace granrad
