#include "raytrace/line_pass/line_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/line_pass/line_walls.h"
#include "raytrace/morton.h"
#include "raytrace/wall_patches.h"

namespace granrad {

namespace {

constexpr double lines_on_a_face = 4096;
constexpr double max_cells = 67108864;  // 2^26 lines of 4 bytes: 256 MiB per thread
/// Corners closer than this share of the enclosure's size are one corner; planarity and convexity are judged
/// by it.
constexpr double corner_tolerance = 1e-7;

Vec3 middle_of(const Box& box) {
  return box.is_empty() ? Vec3{} : 0.5 * (box.min + box.max);
}
double diameter_of(const Box& box) {
  return box.is_empty() ? 0 : norm(box.size());
}
std::vector<Vec3> corners_of(const Box& box) {
  if (box.is_empty()) return {Vec3{}};
  std::vector<Vec3> all;
  for (int k = 0; k < 8; ++k)
    all.push_back(
        {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z});
  return all;
}

/// Indices of the points, such that neighbours in space mostly follow each other.
std::vector<std::int32_t> order_in_space(const std::vector<Vec3>& points, const Box& bounds) {
  constexpr double cells = 1023.999;
  const double scale = cells / std::max(diameter_of(bounds), 1e-300);
  using Coded = std::pair<std::uint32_t, std::int32_t>;
  std::vector<Coded> codes(points.size()), other(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    codes[i] = {morton_code(scale * (points[i] - bounds.min)), static_cast<std::int32_t>(i)};
  constexpr int digit = 10;
  for (int shift = 0; shift < 30; shift += digit) {
    std::uint32_t begin[1 << digit] = {}, sum = 0;
    const auto bucket = [&](const Coded& c) -> std::uint32_t& { return begin[c.first >> shift & 1023]; };
    for (const Coded& c : codes) ++bucket(c);
    for (std::uint32_t& b : begin) sum += std::exchange(b, sum);
    for (const Coded& c : codes) other[bucket(c)++] = c;
    codes.swap(other);
  }
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[i] = codes[i].second;
  return order;
}

/// Largest distance by which a sphere pokes through a wall; collects the centres that stand behind one.
double protrusion(const LineScene& scene, const Enclosure& e, std::vector<std::string>& problems) {
  constexpr std::size_t enough = 20;
  double largest = 0;
  for (std::size_t i = 0; i < scene.x.size(); ++i)
    for (const auto& face : scene.faces) {
      const double distance = dot(Vec3{scene.x[i], scene.y[i], scene.z[i]} - face.corners[0], face.normal);
      largest = std::max(largest, scene.radius[i] - distance);
      const auto at = static_cast<std::size_t>(scene.surface[i]);
      if (distance < 0 && problems.size() < enough)
        problems.push_back(
            fmt::format("lines: particle {} at ({}, {}, {}) stands {} m behind wall {} (no line inside the "
                        "walls meets it); try "
                        "another region",
                        scene.surface[i], e.centre_m[at].x, e.centre_m[at].y, e.centre_m[at].z, -distance,
                        e.walls[static_cast<std::size_t>(face.surface) - scene.x.size()].name));
    }
  return largest;
}

double line_spacing(const Enclosure& e, double lines_per_disc, double diameter) {
  double spacing = 1;
  if (e.sphere_count() > 0) {
    std::vector<double> sorted = e.radius_m;
    const auto tenth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 10);
    std::nth_element(sorted.begin(), tenth, sorted.end());
    spacing = *tenth * std::sqrt(pi / lines_per_disc);
  } else if (!e.walls.empty()) {
    double sum = 0;
    for (const Wall& wall : e.walls) sum += area(wall);
    spacing = std::sqrt(sum / static_cast<double>(e.walls.size()) / lines_on_a_face);
  }
  return std::max(spacing, diameter / std::sqrt(max_cells));
}

}  // namespace

LineSpheres LineScene::spheres() const {
  const float largest = reach.empty() ? 0 : *std::max_element(reach.begin(), reach.end());
  return {static_cast<std::int32_t>(x.size()),
          x.data(),
          y.data(),
          z.data(),
          reach.data(),
          surface.data(),
          largest};
}

LineScene::LineScene(const Enclosure& enclosure, double lines_per_disc, const WallPatches* patches)
    : open_surface(static_cast<std::int32_t>(enclosure.open_surface())) {
  auto problems = shape_problems(enclosure);
  if (!problems.empty()) throw InputError(problems);

  Box all = Box::empty();
  for (const Wall& wall : enclosure.walls)
    for (const Vec3& p : wall.vertices) all.include(p);
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
    all.include(enclosure.centre_m[i], enclosure.radius_m[i]);
  const bool periodic = enclosure.periodic != std::array<bool, 3>{};
  if (periodic) {
    all.include(enclosure.box.min), all.include(enclosure.box.max);
    for (int k = 0; k < 3; ++k) period[k] = enclosure.periodic[k] ? enclosure.box.size()[k] : 0;
  }
  middle = middle_of(all);
  surface = order_in_space(enclosure.centre_m, all);
  for (const std::int32_t s : surface) {
    Vec3 c = enclosure.centre_m[static_cast<std::size_t>(s)];
    for (int k = 0; k < 3; ++k)
      if (period[k] > 0) c[k] -= period[k] * std::floor((c[k] - enclosure.box.min[k]) / period[k]);
    c -= middle;
    x.push_back(c.x), y.push_back(c.y), z.push_back(c.z);
    radius.push_back(enclosure.radius_m[static_cast<std::size_t>(s)]);
  }

  const double tolerance = corner_tolerance * diameter_of(all);
  faces = faces_about(enclosure, middle, tolerance);
  closed = !periodic && edges_close(faces);
  if (periodic && !(edges_close_periodically(faces, period, 10 * tolerance) && holds_volume(enclosure)))
    throw InputError(advised(
        "lines: the walls do not close the directions that are not periodic (or do not run through those that are)",
        "try embree"));
  if (enclosure.periodic == std::array<bool, 3>{true, true, true} && radius.empty())
    throw InputError(
        advised("lines: an empty box, periodic all round (lines would meet nothing)", "add particles"));
  problems = convexity_problems(enclosure, faces, tolerance);
  const bool walls_hold_all = protrusion(*this, enclosure, problems) <= 0 && closed;
  if (!problems.empty()) throw InputError(problems);

  if (walls_hold_all)
    for (const Face& face : faces) hull.insert(hull.end(), face.corners.begin(), face.corners.end());
  else
    for (const Vec3& p : corners_of(all)) hull.push_back(p - middle);
  spacing = line_spacing(enclosure, lines_per_disc, diameter_of(all));
  for (double r : radius) reach.push_back(static_cast<float>(r / spacing));
  if (patches) cut_faces(*patches);
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (f == 0 || faces[f].surface != faces[f - 1].surface) first_face.push_back(f);
  if (periodic) add_periods(enclosure);
}

/// Faces of patches in place of those of their walls, once the walls are known to close and to be convex.
void LineScene::cut_faces(const WallPatches& patches) {
  const std::vector<Face> whole = std::exchange(faces, {});
  const auto spheres = static_cast<std::int32_t>(x.size());
  for (const Face& face : whole) {
    const std::int32_t wall = face.surface - spheres;
    if (!patches.is_cut(wall)) {
      faces.push_back(face);
      faces.back().surface = spheres + patches.first(wall);
      continue;
    }
    if (!faces.empty() && faces.back().surface >= spheres + patches.first(wall))
      continue;  // its further triangles
    for (std::int32_t p = patches.first(wall); p < patches.count() && patches.wall(p) == wall; ++p) {
      faces.push_back({patches.corners(p), polygon_normal(patches.corners(p)), spheres + p});
      for (Vec3& corner : faces.back().corners) corner -= middle;
    }
  }
  open_surface = spheres + patches.count();
}

double LineScene::room_for_images() const {
  return is_periodic() ? 2.0 * spheres().max_reach + 2 : 0;
}

/// An upstream stretch of five mean chords leaves so few line ends to the tracer that they cost no more than the
/// images do.
void LineScene::add_periods(const Enclosure& enclosure) {
  constexpr double chords = 5, most_periods = 20;
  double volume = enclosure.box.volume(), area = 0, shortest = 1e300;
  for (const double r : radius) volume -= sphere_volume(r);
  for (const double a : surface_areas(enclosure)) area += a;
  for (int k = 0; k < 3; ++k)
    if (period[k] > 0) shortest = std::min(shortest, period[k]);
  upstream_m = std::min(chords * 4 * std::max(volume, 0.0) / area, most_periods * shortest);
  tracer = std::make_shared<EmbreeTracer>(enclosure, 1);

  int images[3] = {};
  for (int k = 0; k < 3; ++k)
    if (period[k] > 0) images[k] = static_cast<int>(std::ceil(upstream_m / period[k])) + 1;
  const std::size_t own = faces.size();
  for (int a = -images[0]; a <= images[0]; ++a)
    for (int b = -images[1]; b <= images[1]; ++b)
      for (int c = -images[2]; c <= images[2]; ++c)
        for (std::size_t f = 0; f < own && (a || b || c); ++f) {
          Face face = faces[f];
          for (Vec3& p : face.corners) p += Vec3{a * period.x, b * period.y, c * period.z};
          face.image = true;
          faces.push_back(std::move(face));
        }
}

}  // namespace granrad
