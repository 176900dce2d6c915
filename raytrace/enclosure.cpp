#include "raytrace/enclosure.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/solid_fraction.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/facets.h"

namespace granrad {

namespace {

/// Two places nearer than this part of the box are the same place.
constexpr double same_place = 1e-9;
/// A moved wall clears the spheres by this part of their radius.
constexpr double clearance = 1e-6;

double tolerance_m(const Bed& bed) {
  double extent = norm(bed.box.size());
  for (const auto& wall : bed.walls)
    for (const auto& v : wall.vertices) extent = std::max(extent, norm(v - bed.walls[0].vertices[0]));
  return same_place * extent;
}

/// Whether the wall has some part in the region or on its boundary, more than a common edge.
bool touches(const Wall& wall, const Box& region, double tolerance) {
  const Box bounds = bounds_of(wall);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = bounds.min[axis], high = bounds.max[axis];
    const double shared = std::min(high, region.max[axis]) - std::max(low, region.min[axis]);
    if (shared < -tolerance || (high - low > tolerance && shared < tolerance)) return false;
  }
  return true;
}

bool is_face_of(const Box& box, const Wall& wall, double tolerance) {
  const Box bounds = bounds_of(wall);
  const auto lies_at = [&](int axis, double place) {
    return std::abs(bounds.min[axis] - place) <= tolerance && std::abs(bounds.max[axis] - place) <= tolerance;
  };
  for (int axis = 0; axis < 3; ++axis)
    if (lies_at(axis, box.min[axis]) || lies_at(axis, box.max[axis])) return plane_of(wall).has_value();
  return false;
}

void refuse_spheres_behind_box_walls(const Bed& bed, const Enclosure& enclosure, double tolerance) {
  std::vector<std::string> problems;
  for (const Wall& wall : enclosure.walls) {
    if (!wall.contact || !is_face_of(bed.box, wall, tolerance)) continue;
    const Vec3 normal = plane_of(wall)->normal;
    std::size_t behind = 0, first = 0;
    for (std::size_t s = 0; s < enclosure.sphere_count(); ++s)
      if (dot(normal, enclosure.centre_m[s] - wall.vertices[0]) < 0 && behind++ == 0) first = s;
    if (behind > 0)
      problems.push_back(behind == enclosure.sphere_count()
                             ? advised(fmt::format("wall {} turns its back to all particles", wall.name),
                                       "turn it (flip = true)")
                             : advised(fmt::format("{} particles have their centre behind wall {}, first "
                                                   "particle {} (a particle must lie inside the box)",
                                                   behind, wall.name, bed.id[enclosure.particle[first]]),
                                       "enlarge the box, or drop them"));
  }
  if (!problems.empty()) throw InputError(problems);
}

/// Where corner `corner` of a planar wall goes when the plane it lies on moves by `distance` against `normal`:
/// along the polygon's edge that leaves the plane, or, in a wall of several faces, straight down its plane.
/// Empty when the wall does not leave the plane there.
std::optional<Vec3> slide(const Wall& wall, const WallPlane& plane, std::size_t corner, const Vec3& normal,
                          double distance, double tolerance) {
  const std::size_t n = wall.vertices.size();
  const Vec3& v = wall.vertices[corner];
  if (face_count(wall) > 1) {
    const Vec3 down = dot(normal, plane.normal) * plane.normal - normal;
    const double slope = -dot(normal, down);
    return slope > same_place ? std::optional(v + down * (distance / slope)) : std::nullopt;
  }
  for (const std::size_t next : {(corner + 1) % n, (corner + n - 1) % n}) {
    const Vec3 edge = v - wall.vertices[next];
    const double slope = -dot(normal, edge);
    if (slope > tolerance) return v + edge * (distance / slope);
  }
  return std::nullopt;
}

/// Moves planar wall `moved` by `distance` against its normal and stretches the planar walls with a corner on
/// it.
void move_outwards(std::vector<Wall>& walls, std::size_t moved, double distance, double tolerance) {
  const Vec3 normal = plane_of(walls[moved])->normal;
  const std::vector<WallFace> faces = faces_of(walls[moved]);
  const auto on_it = [&](const Vec3& p) {
    return std::any_of(faces.begin(), faces.end(),
                       [&](const WallFace& face) { return distance_to(face, p) <= tolerance; });
  };
  Wall placed = walls[moved];
  for (auto& v : placed.vertices) v -= normal * distance;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto plane = plane_of(walls[w]);
    if (w == moved || !plane) continue;
    const Wall before = walls[w];
    for (std::size_t k = 0; k < before.vertices.size(); ++k) {
      if (!on_it(before.vertices[k])) continue;
      const auto slid = slide(before, *plane, k, normal, distance, tolerance);
      if (!slid) continue;
      walls[w].vertices[k] = *slid;
      for (std::size_t c = 0; c < placed.vertices.size(); ++c)
        if (norm(walls[moved].vertices[c] - before.vertices[k]) <= tolerance) placed.vertices[c] = *slid;
    }
  }
  walls[moved] = std::move(placed);
}

/// How far a planar wall must move back for its plane to clear every sphere before it.
double protrusion_m(const Enclosure& enclosure, const WallPlane& plane, double tolerance) {
  double distance = 0;
  for (std::size_t s = 0; s < enclosure.sphere_count(); ++s) {
    const double height = plane.height(enclosure.centre_m[s]), r = enclosure.radius_m[s];
    if (height >= -tolerance && height < r) distance = std::max(distance, r * (1 + clearance) - height);
  }
  return distance;
}

/// Walls without contact in one plane (zones of the end of a channel) move together.
void clear_spheres(Enclosure& enclosure, double tolerance) {
  std::vector<char> done(enclosure.walls.size(), 0);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    const auto plane = plane_of(enclosure.walls[w]);
    if (done[w] || enclosure.walls[w].contact || !plane) continue;
    std::vector<std::size_t> together;
    for (std::size_t v = w; v < enclosure.walls.size(); ++v) {
      const auto other = plane_of(enclosure.walls[v]);
      if (enclosure.walls[v].contact || !other || dot(other->normal, plane->normal) < 1 - same_place ||
          std::abs(plane->height(other->point)) > tolerance)
        continue;
      together.push_back(v);
      done[v] = 1;
    }
    const double distance = protrusion_m(enclosure, *plane, tolerance);
    for (const auto v : together)
      if (distance > 0) move_outwards(enclosure.walls, v, distance, tolerance);
  }
}

/// 0 where planar walls do not tell: a mesh, or a region beyond the walls they close.
double region_solid_fraction(const Bed& bed, const Enclosure& enclosure, const Box& region) {
  Facets facets(0);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    if (!plane_of(enclosure.walls[w])) return 0;
    facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), {}, 1);
  }
  const double least = facets.enclosed_volume(enclosure.periodic).value_or(bed.box.volume());
  return region.volume() <= least * (1 + same_place) ? solid_fraction(bed, region) : 0;
}

/// Whether a wall goes on behind another one from an edge they share.
bool goes_on_behind(const Wall& wall, const Wall& front, double tolerance) {
  const auto plane = plane_of(front);
  if (!plane) return false;
  int shared = 0;
  double lowest = 0;
  for (const Vec3& v : wall.vertices) {
    const double height = plane->height(v);
    if (height > tolerance) return false;
    lowest = std::min(lowest, height);
    shared += std::any_of(front.vertices.begin(), front.vertices.end(),
                          [&](const Vec3& p) { return norm(p - v) <= tolerance; });
  }
  return shared >= 2 && lowest < -tolerance;
}

/// Whether a wall belongs to a body with one of the walls `kept`: each goes on behind the other. The walls of a wider hopper
/// before a channel do so too, but there the end of the channel, which they are behind, hides them.
bool completes_a_body(const std::vector<Wall>& walls, std::size_t wall, const std::vector<char>& kept,
                      double tolerance) {
  bool completes = false;
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (!kept[v] || !goes_on_behind(walls[wall], walls[v], tolerance)) continue;
    if (!goes_on_behind(walls[v], walls[wall], tolerance)) return false;
    completes = true;
  }
  return completes;
}

/// By wall: whether it is there and touches the region, or belongs to a body of plates in the box that does. Without its
/// further sides rays would look into the body.
std::vector<char> walls_of_region(const Bed& bed, const Box& region, double tolerance) {
  std::vector<char> may_complete, kept;
  Box around = bed.box;
  around.include(bed.box.min, tolerance);
  around.include(bed.box.max, tolerance);
  for (const Wall& wall : bed.walls) {
    const bool is_there = bed.time_s < wall.opens_at_s;
    kept.push_back(is_there && touches(wall, region, tolerance));
    may_complete.push_back(is_there && !kept.back() &&
                           std::all_of(wall.vertices.begin(), wall.vertices.end(),
                                       [&](const Vec3& v) { return around.contains(v); }));
  }
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t w = 0; w < kept.size(); ++w)
      if (may_complete[w] && !kept[w] && completes_a_body(bed.walls, w, kept, tolerance))
        kept[w] = grows = true;
  }
  return kept;
}

}  // namespace

std::vector<double> surface_areas(const Enclosure& enclosure) {
  std::vector<double> areas;
  areas.reserve(enclosure.surface_count());
  for (const double r : enclosure.radius_m) areas.push_back(4 * pi * r * r);
  for (const Wall& wall : enclosure.walls) areas.push_back(area(wall));
  areas.push_back(0);
  return areas;
}

Enclosure make_enclosure(const Bed& bed, const Box& region) {
  Enclosure enclosure;
  enclosure.periodic = bed.periodic;
  enclosure.box = bed.box;
  const double tolerance = tolerance_m(bed);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!is_finite(bed.position_m[i]))
      throw NumericalError(fmt::format("particle {} has no finite position", bed.id[i]));
    const Vec3 centre = wrapped_into_box(bed, bed.position_m[i]);
    if (!region.contains(centre)) continue;
    enclosure.centre_m.push_back(centre);
    enclosure.radius_m.push_back(bed.radius_m[i]);
    enclosure.particle.push_back(static_cast<std::int32_t>(i));
    enclosure.material.push_back(bed.material[i]);
  }
  const auto kept = walls_of_region(bed, region, tolerance);
  for (std::size_t w = 0; w < bed.walls.size(); ++w) {
    if (!kept[w]) continue;
    enclosure.walls.push_back(bed.walls[w]);
    enclosure.wall.push_back(static_cast<std::int32_t>(w));
  }
  refuse_spheres_behind_box_walls(bed, enclosure, tolerance);
  enclosure.solid_fraction = region_solid_fraction(bed, enclosure, region);
  clear_spheres(enclosure, tolerance);
  return enclosure;
}

}  // namespace granrad
