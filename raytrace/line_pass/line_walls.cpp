#include "raytrace/line_pass/line_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/facets.h"

namespace granrad {

namespace {

/// Replaces corners that nearly coincide by one, so that faces share edges bit by bit.
void weld(std::vector<LineScene::Face>& faces, double tolerance) {
  std::vector<Vec3> known;
  for (auto& face : faces)
    for (Vec3& p : face.corners) {
      const auto same =
          std::find_if(known.begin(), known.end(), [&](const Vec3& q) { return norm(p - q) < tolerance; });
      if (same == known.end())
        known.push_back(p);
      else
        p = *same;
    }
}

}  // namespace

std::vector<std::string> shape_problems(const Enclosure& e) {
  std::vector<std::string> problems;
  for (int k = 0; k < 3; ++k)
    if (e.periodic[k] && !(e.box.size()[k] > 0 && std::isfinite(e.box.size()[k])))
      problems.push_back(
          fmt::format("lines: period in {} = {} (must be positive)", "xyz"[k], e.box.size()[k]));
  for (const Wall& wall : e.walls)
    if (wall.vertices.size() < 3 || !std::all_of(wall.vertices.begin(), wall.vertices.end(), is_finite))
      problems.push_back(fmt::format("lines: wall {} (needs three finite vertices or more)", wall.name));
    else if (!plane_of(wall))
      problems.push_back(
          advised(fmt::format("lines: wall {} is not in one plane (lines need walls that are)", wall.name),
                  "try embree"));
  for (std::size_t i = 0; i < e.sphere_count(); ++i)
    if (!is_finite(e.centre_m[i]) || !(e.radius_m[i] > 0) || !std::isfinite(e.radius_m[i])) {
      problems.push_back(fmt::format("lines: particle {} = ({}, {}, {}), radius {} (must be finite)", i,
                                     e.centre_m[i].x, e.centre_m[i].y, e.centre_m[i].z, e.radius_m[i]));
      break;
    }
  return problems;
}

bool edges_close(const std::vector<LineScene::Face>& faces) {
  using Key = std::array<double, 6>;
  std::map<Key, int> balance;
  for (const auto& face : faces)
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      const Vec3 &a = face.corners[k], &b = face.corners[(k + 1) % face.corners.size()];
      const Key forward{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
      if (forward < back)
        ++balance[forward];
      else
        --balance[back];
    }
  return !faces.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

bool edges_close_periodically(const std::vector<LineScene::Face>& faces, const Vec3& period,
                              double tolerance) {
  struct Edge {
    Vec3 middle, direction;
    bool matched = false;
  };
  std::vector<Edge> edges;
  for (const auto& face : faces)
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      const Vec3 &a = face.corners[k], &b = face.corners[(k + 1) % face.corners.size()];
      edges.push_back({0.5 * (a + b), b - a});
    }
  const auto meet = [&](const Edge& a, const Edge& b) {
    Vec3 apart = a.middle - b.middle;
    for (int k = 0; k < 3; ++k)
      if (period[k] > 0) apart[k] -= period[k] * std::round(apart[k] / period[k]);
    return norm(apart) < tolerance && norm(a.direction + b.direction) < tolerance;
  };
  for (auto e = edges.begin(); e != edges.end(); ++e) {
    if (e->matched) continue;
    const auto other =
        std::find_if(e + 1, edges.end(), [&](const Edge& o) { return !o.matched && meet(*e, o); });
    if (other == edges.end()) return false;
    other->matched = true;
  }
  return true;
}

bool holds_volume(const Enclosure& e) {
  if (e.periodic == std::array<bool, 3>{true, true, true}) return true;
  Facets facets(0);
  for (const Wall& wall : e.walls) facets.add(wall, 0, e.box.min, 1);
  return facets.enclosed_volume(e.periodic).has_value();
}

std::vector<std::string> convexity_problems(const Enclosure& e, const std::vector<LineScene::Face>& faces,
                                            double tolerance) {
  std::vector<std::string> problems;
  const auto name_of = [&](std::size_t face) {
    return e.walls[static_cast<std::size_t>(faces[face].surface) - e.sphere_count()].name;
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t g = 0; g < faces.size(); ++g) {
      const auto outside = [&](const Vec3& p) {
        return dot(p - faces[f].corners[0], faces[f].normal) < -tolerance;
      };
      if (std::any_of(faces[g].corners.begin(), faces[g].corners.end(), outside))
        problems.push_back(
            advised(fmt::format("lines: wall {} stands behind wall {} (the walls must bound a convex space)",
                                name_of(g), name_of(f)),
                    "try embree"));
    }
  return problems;
}

std::vector<LineScene::Face> faces_about(const Enclosure& e, const Vec3& middle, double tolerance) {
  std::vector<LineScene::Face> faces;
  for (std::size_t w = 0; w < e.walls.size(); ++w) {
    const auto surface = static_cast<std::int32_t>(e.sphere_count() + w);
    for (const WallFace& part : faces_of(e.walls[w])) {
      LineScene::Face face{part.vertices, part.normal, surface};
      for (Vec3& p : face.corners) p -= middle;
      faces.push_back(std::move(face));
    }
  }
  weld(faces, tolerance);
  return faces;
}

}  // namespace granrad
