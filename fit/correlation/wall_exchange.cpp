#include "fit/correlation/wall_exchange.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/facets.h"
#include "raytrace/rays/emission.h"

namespace granrad {

namespace {

constexpr int rays_per_wall = 32768;

/// Point k of the additive recurrence with the generalised golden ratio g, g^5 = g + 1 (Roberts' R4
/// sequence).
std::array<double, 4> low_discrepancy_point(int k) {
  constexpr double g = 1.1673039782614186843;
  std::array<double, 4> u;
  double step = 1;
  for (double& x : u) {
    step /= g;
    x = 0.5 + (k + 1) * step;
    x -= std::floor(x);
  }
  return u;
}

/// What of a bed shades a path: Beer's law.
struct Shade {
  const SolidFractionField& field;
  double diameter_m;
  double transmittance(const Vec3& from, const Vec3& direction, double distance) const {
    const double phi = field.uniform() ? field.whole() : field.between(from, from + direction * distance);
    return std::exp(-extinction_1_m(phi, diameter_m) * distance);
  }
};

/// Adds what wall v sends through the bed to each wall; returns the fraction that meets none.
double trace_wall(const Enclosure& empty, const Emitter& emitter, const Facets& facets, std::size_t v,
                  const Shade& shade, double* row) {
  const bool planar = plane_of(empty.walls[v]).has_value();
  int missed = 0;
  for (int k = 0; k < rays_per_wall; ++k) {
    const auto u = low_discrepancy_point(k);
    const auto ray = emitter.emit(static_cast<std::int32_t>(v), u[0], u[1], u[2], u[3]);
    double nearest = infinity;
    std::int32_t wall = -1;
    for (std::int32_t f = 0; f < facets.count(); ++f) {
      if (planar && facets.wall(f) == static_cast<std::int32_t>(v)) continue;
      const double s = facets.front_crossing(f, ray.origin_m, ray.direction);
      if (s < nearest) nearest = s, wall = facets.wall(f);
    }
    if (wall < 0)
      ++missed;
    else
      row[wall] += shade.transmittance(ray.origin_m, ray.direction, nearest);
  }
  return static_cast<double>(missed) / rays_per_wall;
}

}  // namespace

double extinction_1_m(double solid_fraction, double diameter_m) {
  return 1.5 * solid_fraction / (diameter_m * (1 - solid_fraction));
}

WallExchange wall_exchange(const Enclosure& enclosure, const SolidFractionField& field, double diameter_m) {
  const std::size_t walls = enclosure.walls.size();
  Enclosure empty;
  empty.walls = enclosure.walls;
  double size_m = 0;
  for (const auto& wall : empty.walls) size_m = std::max(size_m, std::sqrt(area(wall)));
  Facets facets(1e-9 * size_m);
  for (std::size_t w = 0; w < walls; ++w) facets.add(empty.walls[w], static_cast<std::int32_t>(w), {}, 1);
  const Emitter emitter(empty);

  const Shade shade{field, diameter_m};
  WallExchange result;
  result.walls = walls;
  result.opening.resize(walls);
  std::vector<double> arrived(walls * walls, 0.0);  // weight of the rays v -> w
#pragma omp parallel for schedule(static)
  for (std::size_t v = 0; v < walls; ++v) {
    result.opening[v] = trace_wall(empty, emitter, facets, v, shade, arrived.data() + v * walls);
  }
  result.value.resize(walls * walls);
  for (std::size_t v = 0; v < walls; ++v)
    for (std::size_t w = 0; w < walls; ++w)
      result.value[v * walls + w] = (arrived[v * walls + w] + arrived[w * walls + v]) / rays_per_wall /
                                    (1 / area(empty.walls[v]) + 1 / area(empty.walls[w]));
  return result;
}

}  // namespace granrad
