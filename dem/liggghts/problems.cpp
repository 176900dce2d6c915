#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/bed/wall_distance.h"
#include "dem/engine_liggghts.h"

namespace granrad {

namespace {

constexpr double lowest_restitution = 0.05;  // LIGGGHTS' own bound, exclusive
constexpr double across_tolerance = 1e-9;    // part of a wall's speed that rounding may turn across it

bool moves_across(const Wall& wall) {
  const double speed = norm(wall.velocity_m_s);
  if (speed == 0) return false;
  for (const auto& face : faces_of(wall))
    if (std::abs(dot(face.normal, wall.velocity_m_s)) > across_tolerance * speed) return true;
  return false;
}

}  // namespace

std::vector<std::string> liggghts_problems(const Scene& scene) {
  std::vector<std::string> problems;
  if (scene.precision == Precision::mixed)
    problems.push_back("dem.precision = \"mixed\" is the native engine's; leave it out");
  for (const auto& m : scene.materials)
    if (!(m.restitution > lowest_restitution))
      problems.push_back(fmt::format("material {}: restitution = {} must be above {} there; use \"native\"",
                                     m.name, m.restitution, lowest_restitution));
  const auto& first = scene.materials.front();
  const bool walls =
      std::any_of(scene.walls.begin(), scene.walls.end(), [](const Wall& w) { return w.contact; });
  for (const auto& m : scene.materials)
    if (walls && (m.youngs_modulus_Pa != first.youngs_modulus_Pa || m.poisson_ratio != first.poisson_ratio))
      problems.push_back(
          fmt::format("material {}: youngs_modulus_Pa and poisson_ratio must be those of {} there: walls "
                      "have one of each; use "
                      "\"native\"",
                      m.name, first.name));
  for (const auto& wall : scene.walls)
    if (wall.contact && moves_across(wall))
      problems.push_back(
          fmt::format("wall {}: velocity_m_s must lie in its surface there; use \"native\"", wall.name));
  return problems;
}

}  // namespace granrad
