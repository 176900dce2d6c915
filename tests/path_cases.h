#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "dem/base/constants.h"
#include "raytrace/paths/path_source.h"

namespace granrad::path_cases {

/// An enclosure under construction, with the state of every surface.
struct Case {
  Enclosure enclosure;
  std::vector<double> sphere_temperature_K, sphere_emissivity;
  double surroundings_K = 300;

  void add_sphere(const Vec3& centre, double radius, double temperature_K, double emissivity) {
    enclosure.particle.push_back(static_cast<std::int32_t>(enclosure.sphere_count()));
    enclosure.centre_m.push_back(centre);
    enclosure.radius_m.push_back(radius);
    sphere_temperature_K.push_back(temperature_K);
    sphere_emissivity.push_back(emissivity);
  }
  void add_wall(Wall wall, WallRole role, double temperature_K, double emissivity) {
    wall.role = role;
    wall.temperature_K = temperature_K;
    wall.emissivity = emissivity;
    enclosure.walls.push_back(std::move(wall));
  }
  void add_box(const Box& box, WallRole role, double temperature_K, double emissivity) {
    for (const auto& wall : box_walls(box)) add_wall(wall, role, temperature_K, emissivity);
  }
  Wall& wall(std::size_t w) { return enclosure.walls[w]; }

  RadiativeState state() const {
    RadiativeState s;
    for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
      s.add(sphere_temperature_K[i], sphere_emissivity[i]);
    for (const auto& w : enclosure.walls) s.add(w.temperature_K, w.emissivity, w.role);
    s.add(surroundings_K, 1, WallRole::open);
    return s;
  }

  RadiativeHeat trace(const PathOptions& options, std::uint64_t update = 0) const {
    const EmbreeTracer tracer(enclosure, options.threads);
    return trace_paths(enclosure, tracer, state(), options, update);
  }
};

inline PathOptions walks(std::int64_t count, std::uint64_t seed = 1) {
  PathOptions options;
  options.walks = count;
  options.seed = seed;
  return options;
}

/// A rectangle [0,1]^2 at height z; its normal points up or down.
inline Wall plate(double z, bool up) {
  Wall w;
  w.vertices = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
  if (!up) std::swap(w.vertices[1], w.vertices[3]);
  return w;
}

/// Spheres on a jittered lattice in a box of walls at 1000 K (y) and re-radiating walls (x, z).
inline Case small_bed(double emissivity, int per_side = 5) {
  Case c;
  const double pitch = 1e-3, radius = 4e-4, size = pitch * per_side;
  c.add_box({{0, 0, 0}, {size, size, size}}, WallRole::adiabatic, 300, 1);
  for (int w : {2, 3}) {
    c.wall(w).role = WallRole::isothermal;
    c.wall(w).temperature_K = 1000;
    c.wall(w).emissivity = emissivity;
  }
  for (int k = 0; k < per_side * per_side * per_side; ++k) {
    const Vec3 cell{double(k % per_side), double(k / per_side % per_side), double(k / per_side / per_side)};
    const Vec3 jitter{0.1 * std::sin(3.0 * k), 0.1 * std::sin(5.0 * k + 1), 0.1 * std::sin(7.0 * k + 2)};
    c.add_sphere(pitch * (cell + Vec3{0.5, 0.5, 0.5} + 0.9 * jitter), radius, 300 + 2 * (k % 7), emissivity);
  }
  return c;
}

}  // namespace granrad::path_cases
