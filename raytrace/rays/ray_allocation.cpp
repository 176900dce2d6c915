#include "raytrace/rays/ray_allocation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/rays/ray_rows.h"

namespace granrad {

namespace {

constexpr double fewest_rays = 64;  ///< of a surface: its other factors are in the file too

/// The problem of the header with l = 1; its densities follow by one factor from any other error.
struct Problem {
  std::vector<double> u, v, area;
  double wall_area = 0;

  /// q_i for a given q_w: Newton's method from below on a function that is convex and falls.
  double density(std::size_t i, double wall_density) const {
    if (v[i] == 0) return std::max(0.0, u[i] - wall_density);
    double q = std::max(v[i], u[i] - wall_density);
    for (int step = 0; step < 6; ++step) {
      const double a = u[i] / (q + wall_density), b = v[i] / q;
      q += (a * a + b * b - 1) / (2 * (a * a / (q + wall_density) + b * b / q));
    }
    return q;
  }
  /// Area of walls that would be worth this density of theirs.
  double worth(double wall_density) const {
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double seen = density(i, wall_density) + wall_density;
      if (seen > 0) sum += area[i] * (u[i] / seen) * (u[i] / seen);
    }
    return sum;
  }
  double best_wall_density() const {
    if (wall_area == 0 || worth(0) <= wall_area) return 0;
    double low = 0, high = *std::max_element(u.begin(), u.end());
    while (worth(high) > wall_area) high *= 2;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (worth(middle) > wall_area ? low : high) = middle;
    }
    return high;
  }
};

Problem measured_problem(const HitCounts& known, const StatedQuantity& quantity, const ParticleSums& sums) {
  Problem p;
  double wall_rays = 0;
  for (std::size_t w = static_cast<std::size_t>(known.spheres); w < known.launched.size(); ++w) {
    if (!quantity.counted[w]) continue;
    p.wall_area += known.area_m2[w];
    wall_rays += static_cast<double>(known.launched[w]);
  }
  const double wall_density = p.wall_area > 0 ? wall_rays / p.wall_area : 0;
  for (std::size_t i = 0; i < sums.value.size(); ++i) {
    const double area = known.area_m2[i], own = static_cast<double>(known.launched[i]);
    const double seen = own + wall_density * area;
    const double half_a_hit = 0.5 / (seen * seen);  // a particle not yet seen is not known to be dark
    p.area.push_back(area);
    p.u.push_back(area > 0 ? std::sqrt(std::max(sums.variance[i] - sums.of_row[i], half_a_hit) * seen) / area
                           : 0);
    p.v.push_back(area > 0 ? std::sqrt(sums.of_row[i] * own) / area : 0);
  }
  return p;
}

}  // namespace

std::vector<std::int64_t> rays_per_surface(const Enclosure& enclosure, const std::vector<double>& area,
                                           double rays_per_particle) {
  const std::size_t spheres = enclosure.sphere_count(), walls = enclosure.walls.size();
  const std::size_t count = spheres > 0 ? spheres : walls;
  const double total = std::accumulate(area.begin(), area.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
  std::vector<std::int64_t> rays(enclosure.surface_count(), 0);
  for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
    if (!(area[i] > 0)) continue;
    const double share = i < spheres || total == 0 ? 1 : area[i] * static_cast<double>(count) / total;
    rays[i] = static_cast<std::int64_t>(std::ceil(std::max(1.0, rays_per_particle * share)));
  }
  spare_wide_walls(rays, spheres, rays_per_particle);
  return rays;
}

void spare_wide_walls(std::vector<std::int64_t>& rays, std::size_t spheres, double rays_per_particle) {
  constexpr double worth = 600, least_worth = 6,
                   many_rays = 6e6;  // of a box: 100 times a particle's from each face
  if (spheres == 0) return;
  const auto first_wall = rays.begin() + static_cast<std::ptrdiff_t>(spheres);
  const double from_spheres = std::accumulate(rays.begin(), first_wall, 0.0);
  const double from_walls = std::accumulate(first_wall, rays.end(), 0.0);
  const double most = std::max(
      {from_spheres, least_worth * rays_per_particle, std::min(worth * rays_per_particle, many_rays)});
  if (from_walls <= most) return;
  for (auto wall = first_wall; wall != rays.end(); ++wall) {
    const auto own = static_cast<double>(*wall);
    *wall = std::llround(std::max(std::min(own, rays_per_particle), own * most / from_walls));
  }
}

std::vector<std::int64_t> rays_for_error(const HitCounts& known, const StatedQuantity& quantity,
                                         double error) {
  const ParticleSums sums = particle_sums(known, quantity);
  const double part = error / sums.relative_error(quantity.relative_to_rms);
  const double allowed = part * part * std::accumulate(sums.variance.begin(), sums.variance.end(), 0.0);
  const Problem p = measured_problem(known, quantity, sums);
  const double wall_density = p.best_wall_density();
  double variance = 0;
  for (std::size_t i = 0; i < p.u.size(); ++i) {
    const double q = p.density(i, wall_density);
    if (q > 0) variance += p.area[i] * p.v[i] * p.v[i] / q;
    if (q + wall_density > 0) variance += p.area[i] * p.u[i] * p.u[i] / (q + wall_density);
  }
  const double scale = variance / allowed;

  std::vector<std::int64_t> rays(known.launched.size(), 0);
  double total = 0, area = 0;
  const auto send = [&](std::size_t i, double density) {
    if (known.area_m2[i] > 0)
      rays[i] = std::llround(std::clamp(density * known.area_m2[i], fewest_rays, 1e15));
  };
  for (std::size_t i = 0; i < p.u.size(); ++i) {
    send(i, scale * p.density(i, wall_density));
    total += static_cast<double>(rays[i]);
    area += p.area[i];
  }
  for (std::size_t w = p.u.size(); w + 1 < rays.size(); ++w)
    send(w, quantity.counted[w] && wall_density > 0 ? scale * wall_density : total / area);
  if (wall_density == 0) spare_wide_walls(rays, p.u.size(), total / static_cast<double>(p.u.size()));
  return rays;
}

}  // namespace granrad
