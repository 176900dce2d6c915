#include <fmt/format.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/plugin.h"
#include "dem/bed/wall_shape.h"
#include "dem/engine_liggghts.h"
#include "dem/liggghts/plugin.h"

namespace granrad {

namespace {

constexpr double lowest_restitution = 0.05;  // LIGGGHTS' own bound, exclusive

}  // namespace

std::vector<std::string> liggghts_problems(const Scene& scene) {
  if (plugin_file("granrad_liggghts").empty()) return {liggghts_absent()};
  std::vector<std::string> problems;
  if (scene.precision == Precision::mixed)
    problems.push_back(advised("dem.precision = \"mixed\" is the native engine's", "leave it out"));
  for (const auto& m : scene.materials)
    if (!(m.restitution > lowest_restitution))
      problems.push_back(advised(fmt::format("material {}: restitution = {} must be above {} there", m.name,
                                             m.restitution, lowest_restitution),
                                 "use \"native\""));
  const auto& first = scene.materials.front();
  const bool walls =
      std::any_of(scene.walls.begin(), scene.walls.end(), [](const Wall& w) { return w.contact; });
  for (const auto& m : scene.materials)
    if (walls && (m.youngs_modulus_Pa != first.youngs_modulus_Pa || m.poisson_ratio != first.poisson_ratio))
      problems.push_back(advised(fmt::format("material {}: youngs_modulus_Pa and poisson_ratio must be those "
                                             "of {} there: walls have one of each",
                                             m.name, first.name),
                                 "use \"native\""));
  return problems;
}

}  // namespace granrad
