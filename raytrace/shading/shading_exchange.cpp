#include "raytrace/shading/shading_exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "raytrace/rays/patch_rays.h"
#include "raytrace/rays/ray_rows.h"
#include "raytrace/shading/empty_room.h"
#include "raytrace/shading/sphere_shading.h"
#include "raytrace/unobstructed_pair.h"

namespace granrad {

namespace {

double square(double x) {
  return x * x;
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

/// What spheres and whole walls exchange, [sphere][wall], as known without any ray: what the empty room would give less
/// what the sphere sees of others. Its error is that of many pairs, that of rays falls with their number.
struct SphereWalls {
  std::vector<double> value, variance;
};

SphereWalls spheres_to_walls(const Enclosure& enclosure, const EmptyRoom& room, const SphereShading& shading,
                             const ShadingOptions& options) {
  auto [factor, variance] = room.factors(enclosure, options.seed, options.threads);
  for (std::size_t k = 0; k < factor.size(); ++k) {
    const double r = enclosure.radius_m[k / room.walls()], area = 4 * pi * r * r;
    variance[k] =
        area * area * (variance[k] + shading.hidden_variance[k] + square(shading.beyond * factor[k]));
    factor[k] = area * (factor[k] - shading.hidden[k]);
  }
  return {std::move(factor), std::move(variance)};
}

/// The X >= 0 of which rays, each worth `ray`, gave `counted` (Poisson), and another estimate `known` (normal): the maximum
/// of counted / ray ln X - X / ray - (X - known)^2 / (2 variance). Inverse variances where there are many rays; where none
/// came, as far as known is beyond its noise.
double most_likely(double counted, double ray, double known, double variance) {
  const double middle = 0.5 * (known - variance / ray);
  return middle + std::sqrt(square(middle) + counted * variance / ray);
}

/// Wall rows by rays, each pair of walls from both ends.
class WallRows {
 public:
  WallRows(const Enclosure& whole, const Enclosure& surfaces, const WallPatches* patches,
           const HitCounts& counts)
      : spheres_(whole.sphere_count()),
        walls_(whole.walls.size()),
        open_(surfaces.open_surface()),
        centre_m_(whole.centre_m),
        patches_(patches),
        rays_(one_way_estimate(counts)),
        one_ray_(walls_, 0) {
    for (std::size_t s = spheres_; s < open_; ++s)
      one_ray_[wall_of(s)] =
          std::max(one_ray_[wall_of(s)], counts.area_m2[s] / static_cast<double>(counts.launched[s]));
  }

  /// Adds them, what a sphere and a whole wall exchange merged with what is known without rays; how it
  /// lies on the patches is told by the rays. Returns whether any ray left the walls.
  bool add(const SphereWalls& known, Assembly& assembly) const {
    const Factors by = merge(known, assembly);
    bool anything_open = open_ == spheres_;
    visit([&](std::size_t w, std::size_t j, std::int64_t k) {
      const double part = j >= spheres_ && j != w && j < open_ ? 0.5 : 1;
      const std::size_t pair = j * walls_ + wall_of(w);
      assembly.add(w, j, (j < spheres_ ? by.value[pair] : part) * rays_.value[k],
                   (j < spheres_ ? by.variance[pair] : part * part) * rays_.variance[k]);
      anything_open = anything_open || j == open_;
    });
    return anything_open;
  }

 private:
  std::size_t wall_of(std::size_t surface) const {
    const auto patch = surface - spheres_;
    return patches_ ? static_cast<std::size_t>(patches_->wall(static_cast<std::int32_t>(patch))) : patch;
  }
  template <class Visit>
  void visit(Visit&& visit) const {
    for (std::size_t w = spheres_; w < open_; ++w)
      for (auto k = rays_.pattern.row_begin[w]; k < rays_.pattern.row_begin[w + 1]; ++k)
        visit(w, static_cast<std::size_t>(rays_.pattern.column[k]), k);
  }

  /// What to multiply values and variances of rays by, [sphere][wall].
  struct Factors {
    std::vector<double> value, variance;
  };

  /// Where no ray met a sphere, adds the pair.
  Factors merge(const SphereWalls& known, Assembly& assembly) const {
    Factors by{std::vector<double>(known.value.size(), 0), std::vector<double>(known.value.size(), 0)};
    std::vector<double> sum(walls_, 0), variance(walls_, 0);
    visit([&](std::size_t w, std::size_t j, std::int64_t k) {
      if (j >= spheres_) return;
      by.value[j * walls_ + wall_of(w)] += rays_.value[k];
      by.variance[j * walls_ + wall_of(w)] += rays_.variance[k];
      sum[wall_of(w)] += rays_.value[k];
      variance[wall_of(w)] += rays_.variance[k];
    });
    for (std::size_t k = 0; k < by.value.size(); ++k) {
      const std::size_t wall = k % walls_;
      const double ray = sum[wall] > 0 ? variance[wall] / sum[wall] : one_ray_[wall];
      const double merged = most_likely(by.value[k], ray, known.value[k], known.variance[k]);
      const double of_rays = ray * std::max(ray, merged),
                   error2 = of_rays * known.variance[k] / (of_rays + known.variance[k]);
      if (by.value[k] > 0) {
        by.value[k] = merged / by.value[k];
        by.variance[k] = error2 / by.variance[k];
      } else {
        assembly.add(k / walls_, surface_of(wall, centre_m_[k / walls_]), merged, error2);
      }
    }
    return by;
  }

  /// The wall, or of one that is cut the patch below a point.
  std::size_t surface_of(std::size_t wall, const Vec3& point) const {
    const auto w = static_cast<std::int32_t>(wall);
    return spheres_ + (patches_ ? static_cast<std::size_t>(patches_->at(w, point, point)) : wall);
  }

  std::size_t spheres_, walls_, open_;
  const std::vector<Vec3>& centre_m_;
  const WallPatches* patches_;
  ExchangeAreas rays_;
  std::vector<double> one_ray_;  ///< [walls] the exchange area one ray stands for
};

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
  const EmptyRoom room(enclosure, options.threads);
  Assembly assembly(surface_areas(walls.surfaces()));
  const SphereShading shading = shade_spheres(enclosure, room, options.threads);
  for (const VisiblePair& pair : shading.pairs) {
    const double r_i = enclosure.radius_m[pair.i], r_j = enclosure.radius_m[pair.j];
    const double full = 4 * pi * r_i * r_j * unobstructed_pair(pair.distance_m / (r_i + r_j));
    assembly.add(pair.i, pair.j, full * pair.open_share, full * full * pair.variance);
  }
  const double rays =
      options.rays_per_particle * static_cast<double>(std::max<std::size_t>(1, enclosure.sphere_count()));
  const WallRows rows(enclosure, walls.surfaces(), options.patches,
                      walls.trace_walls(rays, options.seed, options.threads));
  const bool anything_open = rows.add(spheres_to_walls(enclosure, room, shading, options), assembly);
  if (anything_open)
    for (std::size_t i = 0; i < enclosure.sphere_count(); ++i)
      assembly.add(i, walls.surfaces().open_surface(), assembly.missing_m2(i), 0);
  return assembly.take();
}

}  // namespace granrad
