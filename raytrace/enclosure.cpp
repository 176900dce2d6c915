#include "raytrace/enclosure.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/solid_fraction.h"
#include "dem/bed/wall_distance.h"
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
  for (int axis = 0; axis < 3; ++axis) {
    double low = wall.vertices[0][axis], high = low;
    for (const auto& v : wall.vertices) {
      low = std::min(low, v[axis]);
      high = std::max(high, v[axis]);
    }
    const double shared = std::min(high, region.max[axis]) - std::max(low, region.min[axis]);
    if (shared < -tolerance || (high - low > tolerance && shared < tolerance)) return false;
  }
  return true;
}

bool is_face_of(const Box& box, const Wall& wall, double tolerance) {
  if (!wall.is_polygon()) return false;
  const auto lies_at = [&](int axis, double place) {
    return std::all_of(wall.vertices.begin(), wall.vertices.end(),
                       [&](const Vec3& v) { return std::abs(v[axis] - place) <= tolerance; });
  };
  for (int axis = 0; axis < 3; ++axis)
    if (lies_at(axis, box.min[axis]) || lies_at(axis, box.max[axis])) return true;
  return false;
}

void refuse_spheres_behind_box_walls(const Bed& bed, const Enclosure& enclosure, double tolerance) {
  std::vector<std::string> problems;
  for (const Wall& wall : enclosure.walls) {
    if (!wall.contact || !is_face_of(bed.box, wall, tolerance)) continue;
    const Vec3 normal = polygon_normal(wall);
    std::size_t behind = 0, first = 0;
    for (std::size_t s = 0; s < enclosure.sphere_count(); ++s)
      if (dot(normal, enclosure.centre_m[s] - wall.vertices[0]) < 0 && behind++ == 0) first = s;
    if (behind > 0)
      problems.push_back(
          fmt::format("{} particles have their centre behind wall {}, first particle {} (a particle "
                      "must lie inside the box): enlarge the box or drop them",
                      behind, wall.name, bed.id[enclosure.particle[first]]));
  }
  if (!problems.empty()) throw InputError(problems);
}

/// Where corner `corner` of a polygon goes when the plane it lies on moves by `distance` against `normal`:
/// along the polygon's edge that leaves the plane. Empty when both edges stay in the plane.
std::optional<Vec3> slide_along_edge(const Wall& polygon, std::size_t corner, const Vec3& normal,
                                     double distance, double tolerance) {
  const std::size_t n = polygon.vertices.size();
  const Vec3& v = polygon.vertices[corner];
  for (const std::size_t next : {(corner + 1) % n, (corner + n - 1) % n}) {
    const Vec3 edge = v - polygon.vertices[next];
    const double slope = -dot(normal, edge);
    if (slope > tolerance) return v + edge * (distance / slope);
  }
  return std::nullopt;
}

/// Moves polygon `moved` by `distance` against its normal and stretches the polygons with a corner on it.
void move_outwards(std::vector<Wall>& walls, std::size_t moved, double distance, double tolerance) {
  const Vec3 normal = polygon_normal(walls[moved]);
  const WallFace face = faces_of(walls[moved]).front();
  Wall placed = walls[moved];
  for (auto& v : placed.vertices) v -= normal * distance;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (w == moved || !walls[w].is_polygon()) continue;
    const Wall before = walls[w];
    for (std::size_t k = 0; k < before.vertices.size(); ++k) {
      if (distance_to(face, before.vertices[k]) > tolerance) continue;
      const auto slid = slide_along_edge(before, k, normal, distance, tolerance);
      if (!slid) continue;
      walls[w].vertices[k] = *slid;
      for (std::size_t c = 0; c < face.vertices.size(); ++c)
        if (norm(face.vertices[c] - before.vertices[k]) <= tolerance) placed.vertices[c] = *slid;
    }
  }
  walls[moved] = std::move(placed);
}

void clear_spheres(Enclosure& enclosure, double tolerance) {
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    const Wall& wall = enclosure.walls[w];
    if (wall.contact || !wall.is_polygon()) continue;
    const Vec3 normal = polygon_normal(wall);
    double distance = 0;
    for (std::size_t s = 0; s < enclosure.sphere_count(); ++s) {
      const double height = dot(normal, enclosure.centre_m[s] - wall.vertices[0]), r = enclosure.radius_m[s];
      if (height >= -tolerance && height < r) distance = std::max(distance, r * (1 + clearance) - height);
    }
    if (distance > 0) move_outwards(enclosure.walls, w, distance, tolerance);
  }
}

/// 0 where polygons do not tell: a mesh, or a region beyond the walls they close.
double region_solid_fraction(const Bed& bed, const Enclosure& enclosure, const Box& region) {
  Facets facets(0);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    if (!enclosure.walls[w].is_polygon()) return 0;
    facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), {}, 1);
  }
  const double least = facets.enclosed_volume(enclosure.periodic).value_or(bed.box.volume());
  return region.volume() <= least * (1 + same_place) ? solid_fraction(bed, region) : 0;
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
  }
  for (std::size_t w = 0; w < bed.walls.size(); ++w) {
    if (bed.time_s >= bed.walls[w].opens_at_s || !touches(bed.walls[w], region, tolerance)) continue;
    enclosure.walls.push_back(bed.walls[w]);
    enclosure.wall.push_back(static_cast<std::int32_t>(w));
  }
  refuse_spheres_behind_box_walls(bed, enclosure, tolerance);
  enclosure.solid_fraction = region_solid_fraction(bed, enclosure, region);
  clear_spheres(enclosure, tolerance);
  return enclosure;
}

}  // namespace granrad
