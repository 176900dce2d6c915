#include "raytrace/lines/wall_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

WallPatches::WallPatches(const std::vector<Wall>& walls, double longest_m) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Wall& wall = walls[w];
    const auto plane = plane_of(wall);
    if (!plane)
      throw InputError(advised(fmt::format("wall {} is not in one plane (it has no patches)", wall.name),
                               "use order = 0, or source = \"paths\""));
    const Vec3& corner = wall.vertices[0];
    const Vec3 u = normalized(wall.vertices[1] - corner), v = cross(plane->normal, u);
    double low[2] = {0, 0}, high[2] = {0, 0};
    for (const Vec3& p : wall.vertices) {
      const double at[2] = {dot(p - corner, u), dot(p - corner, v)};
      for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    Grid grid;
    grid.origin = corner + low[0] * u + low[1] * v;
    const auto pieces = [&](int k) {
      return std::max(1, static_cast<std::int32_t>(std::ceil((high[k] - low[k]) / longest_m * (1 - 1e-9))));
    };
    grid.columns = pieces(0), grid.rows = pieces(1);
    grid.u = (grid.columns / (high[0] - low[0])) * u;
    grid.v = (grid.rows / (high[1] - low[1])) * v;
    grid.first = count();
    wall_.insert(wall_.end(), static_cast<std::size_t>(grid.columns) * grid.rows,
                 static_cast<std::int32_t>(w));
    grid_.push_back(grid);
  }
}

std::int32_t WallPatches::at(std::int32_t wall, const Vec3& point) const {
  const Grid& g = grid_[wall];
  const Vec3 p = point - g.origin;
  const auto column = std::clamp(static_cast<std::int32_t>(dot(p, g.u)), 0, g.columns - 1);
  const auto row = std::clamp(static_cast<std::int32_t>(dot(p, g.v)), 0, g.rows - 1);
  return g.first + row * g.columns + column;
}

}  // namespace granrad
