#include "raytrace/shading/shading_exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "raytrace/exact.h"
#include "raytrace/rays/patch_rays.h"
#include "raytrace/rays/ray_rows.h"
#include "raytrace/shading/beam_lines.h"
#include "raytrace/shading/sphere_shading.h"

namespace granrad {

namespace {

/// Counts of rays that the walls send.
HitCounts trace_walls(const PatchRays& from, const ShadingOptions& options) {
  const Enclosure& enclosure = from.surfaces();
  const auto area = surface_areas(enclosure);
  const std::size_t spheres = enclosure.sphere_count();
  const double walls = std::accumulate(area.begin() + static_cast<std::ptrdiff_t>(spheres), area.end(), 0.0);
  constexpr double least_rays = 1000, least_of_patch = 64;
  const double least = options.patches ? least_of_patch : least_rays;
  const double all = options.rays_per_particle * static_cast<double>(std::max<std::size_t>(1, spheres));
  std::vector<std::int64_t> rays(enclosure.surface_count(), 0);
  for (std::size_t s = spheres; s < enclosure.open_surface(); ++s)
    rays[s] = std::llround(std::max(least, all * area[s] / walls));
  TraceOptions trace;
  trace.seed = options.seed;
  trace.threads = options.threads;
  return trace_rows(enclosure, area, rays, trace, [&](const EmittedRay& ray) { return from.follow(ray); });
}

class Assembly {
 public:
  explicit Assembly(std::vector<double> area) : rows_(area.size()), area_(std::move(area)) {}

  void add(std::size_t i, std::size_t j, double value, double variance) {
    if (!(value > 0)) return;
    rows_[i].push_back({static_cast<std::int32_t>(j), value, variance});
    if (i != j) rows_[j].push_back({static_cast<std::int32_t>(i), value, variance});
  }
  double missing_m2(std::size_t i) const {
    double sum = 0;
    for (const auto& e : rows_[i]) sum += e.value;
    return area_[i] - sum;
  }
  ExchangeAreas take() {
    ExchangeAreas areas;
    areas.area_m2 = std::move(area_);
    areas.pattern.row_begin.push_back(0);
    for (auto& row : rows_) {
      std::sort(row.begin(), row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
      for (std::size_t k = 1; k < row.size(); ++k)
        if (row[k].column == row[k - 1].column) {  // seen from both ends
          row[k].value += std::exchange(row[k - 1].value, 0);
          row[k].variance += row[k - 1].variance;
        }
      std::erase_if(row, [](const Entry& e) { return e.value == 0; });
      for (const Entry& e : row) {
        areas.pattern.column.push_back(e.column);
        areas.value.push_back(e.value);
        areas.variance.push_back(e.variance);
      }
      areas.pattern.row_begin.push_back(static_cast<std::int64_t>(areas.value.size()));
    }
    return areas;
  }

 private:
  struct Entry {
    std::int32_t column;
    double value, variance;
  };
  std::vector<std::vector<Entry>> rows_;
  std::vector<double> area_;
};

/// Wall rows, each pair of walls from both ends. Returns whether any ray left the walls.
bool add_walls(const Enclosure& enclosure, const HitCounts& counts, Assembly& assembly) {
  const ExchangeAreas one_way = one_way_estimate(counts);
  const std::size_t spheres = enclosure.sphere_count(), open = enclosure.open_surface();
  bool anything_open = open == spheres;
  for (std::size_t w = spheres; w < open; ++w)
    for (auto k = one_way.pattern.row_begin[w]; k < one_way.pattern.row_begin[w + 1]; ++k) {
      const auto j = static_cast<std::size_t>(one_way.pattern.column[k]);
      const double part = j >= spheres && j != w && j < open ? 0.5 : 1;
      assembly.add(w, j, part * one_way.value[k], part * part * one_way.variance[k]);
      anything_open = anything_open || j == open;
    }
  return anything_open;
}

}  // namespace

void refuse_what_shading_cannot_serve(const Enclosure& enclosure, double rays_per_particle) {
  constexpr double fewest_rays = 10;
  std::vector<std::string> problems;
  const auto [low, high] = std::minmax_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
  if (!enclosure.radius_m.empty() && *high > 1.01 * *low)
    problems.push_back(
        advised(fmt::format("shading: radii = {:.4g} to {:.4g} m (lines between equal spheres, within 1 %)",
                            *low, *high),
                "choose source = paths, lines or embree"));
  if (enclosure.periodic != std::array<bool, 3>{})
    problems.push_back(
        advised("shading: the box is periodic (walls are needed)", "choose source = paths, lines or embree"));
  const auto area = surface_areas(enclosure);
  const auto wall = area.begin() + static_cast<std::ptrdiff_t>(enclosure.sphere_count());
  const double of_spheres = std::accumulate(area.begin(), wall, 0.0),
               of_walls = std::accumulate(wall, area.end(), 0.0);
  if (const double due = rays_per_particle * of_spheres / of_walls; of_spheres > 0 && due < fewest_rays)
    problems.push_back(advised(
        fmt::format(
            "shading: {:.2g} of the walls' rays would meet a sphere (the walls are {:.2g} times as wide as all "
            "spheres; their rays tell what a sphere and a wall exchange)",
            due, of_walls / of_spheres),
        "choose source = paths or embree, or more rays"));
  if (!problems.empty()) throw InputError(problems);
}

ExchangeAreas shading_exchange_areas(const Enclosure& enclosure, const ShadingOptions& options) {
  refuse_what_shading_cannot_serve(enclosure, options.rays_per_particle);
  const PatchRays walls(enclosure, options.patches, options.threads);
  Assembly assembly(surface_areas(walls.surfaces()));
  for (const VisiblePair& pair : visible_pairs(enclosure, options.threads)) {
    const double r_i = enclosure.radius_m[pair.i], r_j = enclosure.radius_m[pair.j];
    const double full = 4 * pi * r_i * r_i * exact_two_sphere(r_i, r_j, pair.distance_m);
    assembly.add(pair.i, pair.j, full * pair.open_share,
                 full * full * pair.open_share * (1 - pair.open_share) / BeamLines::count);
  }
  const bool anything_open = add_walls(walls.surfaces(), trace_walls(walls, options), assembly);
  if (anything_open)
    for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
      assembly.add(i, walls.surfaces().open_surface(), assembly.missing_m2(i), 0);
  return assembly.take();
}

}  // namespace granrad
