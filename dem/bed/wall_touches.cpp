#include <algorithm>
#include <cmath>

#include "dem/bed/wall_surface.h"

namespace granrad {

namespace {

/// Contact points closer than this fraction of the radius are one.
constexpr double same_point = 1e-4;
/// Adjacent faces bent by less than one degree are one smooth wall.
constexpr double smooth_bend = 0.99985;

}  // namespace

bool WallSurface::repeats(const Touch& t, const Touch& kept, double tolerance_m) const {
  if (t.feature == kept.feature || norm(t.point - kept.point) < tolerance_m) return true;
  if (kept.kind == Kind::face && t.kind != Kind::face)
    return std::abs(dot(t.point - kept.point, kept.normal)) < tolerance_m;
  return kept.kind == Kind::face && t.kind == Kind::face && dot(t.normal, kept.normal) > smooth_bend &&
         adjacent(t.feature, kept.feature);
}

std::vector<WallSurface::Touch> WallSurface::distinct(std::vector<Touch> all, double radius_m) const {
  std::sort(all.begin(), all.end(), [](const Touch& a, const Touch& b) {
    if (a.kind != b.kind) return a.kind < b.kind;
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.feature < b.feature;
  });
  std::vector<Touch> kept;
  for (const auto& t : all) {
    const auto same = [&](const Touch& k) { return repeats(t, k, same_point * radius_m); };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(t);
  }
  return kept;
}

std::vector<WallSurface::Touch> WallSurface::distinct_touches(const std::int32_t* begin,
                                                              const std::int32_t* end, const Vec3& p,
                                                              double reach_m, double radius_m) const {
  std::vector<Touch> all;
  for (auto f = begin; f != end; ++f) touches(*f, p, reach_m, all);
  if (all.empty())
    for (auto f = begin; f != end; ++f)
      if (stands(*f) && distance(*f, p) < reach_m) all.push_back(nearest(*f, p));
  return distinct(std::move(all), radius_m);
}

std::int32_t WallSurface::wall_facing(const Touch& touch, const Vec3& p, const std::int32_t* begin,
                                      const std::int32_t* end) const {
  const Facet& own = facets_[touch.facet];
  if (touch.kind != Kind::face || dot(p - own.point, own.normal) >= 0) return own.wall;
  if (own.back >= 0) return facets_[own.back].wall;
  const auto other = std::find_if(begin, end, [&](std::int32_t f) {
    return dot(facets_[f].normal, own.normal) < 0 && in_one_plane(touch.facet, f) && foot_inside(f, p);
  });
  return other == end ? own.wall : facets_[*other].wall;
}

}  // namespace granrad
