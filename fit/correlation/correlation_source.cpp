#include "fit/correlation/correlation_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/cell_grid.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/wall_exchange.h"
#include "raytrace/exact.h"
#include "raytrace/rays/patch_rays.h"

namespace granrad {

namespace {

/// Entries of one row in ascending columns.
struct SphereRow {
  std::vector<std::int32_t> column;
  std::vector<double> value;
  void add(std::size_t c, double x) {
    column.push_back(static_cast<std::int32_t>(c));
    value.push_back(x);
  }
  double sum() const { return std::accumulate(value.begin(), value.end(), 0.0); }
  /// Puts columns in order, equal ones into one.
  void sort() {
    std::vector<std::size_t> order(column.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return column[a] < column[b]; });
    SphereRow sorted;
    for (const std::size_t k : order)
      if (!sorted.column.empty() && sorted.column.back() == column[k])
        sorted.value.back() += value[k];
      else
        sorted.add(static_cast<std::size_t>(column[k]), value[k]);
    *this = std::move(sorted);
  }
};

void refuse_what_a_table_cannot_serve(const CorrelationTable& table, const Enclosure& enclosure) {
  const std::string advice = "trace view factors instead";
  std::vector<std::string> problems;
  if (!enclosure.radius_m.empty()) {
    const auto [low, high] = std::minmax_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
    if (*high > 1.01 * *low)
      problems.push_back(advised(
          fmt::format("{}: radii = {:.4g} to {:.4g} m (correlations hold for equal spheres, within 1 %)",
                      table.name, *low, *high),
          advice));
  }
  for (const auto& wall : enclosure.walls)
    if (!plane_of(wall))
      problems.push_back(
          advised(fmt::format("{}: wall {} is not in one plane (correlations hold for planar walls)",
                              table.name, wall.name),
                  advice));
  for (int axis = 0; axis < 3; ++axis)
    if (enclosure.periodic[axis])
      problems.push_back(advised(
          fmt::format("{}: the box is periodic in {} (correlations need walls)", table.name, "xyz"[axis]),
          advice));
  if (!problems.empty()) throw InputError(problems);
}

/// A table at every solid fraction a field has: at the whole's, or at steps between which F is interpolated.
class LocalCorrelation {
 public:
  LocalCorrelation(const CorrelationTable& table, const SolidFractionField& field, double farthest)
      : last_(table.rows.back().solid_fraction) {
    if (field.uniform()) {
      levels_.emplace_back(table, field.whole(), farthest);
      return;
    }
    const double high = std::min(field.largest(), last_);
    const auto count = static_cast<std::size_t>(std::ceil(high / step)) + 1;
    for (std::size_t k = 0; k < count; ++k)
      levels_.emplace_back(table, std::min(static_cast<double>(k) * step, last_), farthest);
  }

  double pp(double d_star, double phi) const {
    return mixed(phi, [&](const Correlation& level) { return level.pp(d_star); });
  }
  double pw(double h_over_d, double unobstructed, double phi) const {
    return mixed(phi, [&](const Correlation& level) { return level.pw(h_over_d, unobstructed); });
  }
  double cutoff() const { return levels_.front().pp_cutoff(); }

 private:
  static constexpr double step = 0.01;

  template <class Function>
  double mixed(double phi, Function&& function) const {
    if (levels_.size() == 1) return function(levels_.front());
    const auto upper =
        std::upper_bound(levels_.begin() + 1, levels_.end() - 1, phi,
                         [](double p, const Correlation& c) { return p < c.solid_fraction(); });
    const auto& low = *(upper - 1);
    const double t =
        std::min(1.0, (phi - low.solid_fraction()) / (upper->solid_fraction() - low.solid_fraction()));
    return (1 - t) * function(low) + t * function(*upper);
  }

  double last_;
  std::vector<Correlation> levels_;  ///< ascending
};

/// d* beyond which all pairs together hold less than `negligible` of a row: sum of F over shells of
/// 24 phi d*^2 dd* spheres.
double farthest_that_counts(const CorrelationTable& table, double solid_fraction) {
  constexpr double negligible = 2e-4, step = 0.125;
  const double phi = std::min(solid_fraction, table.rows.back().solid_fraction);
  const Correlation correlation(table, phi);
  double beyond = 0, d = table.pp_cutoff;
  for (; d > 2; d -= step) {
    const double middle = d - 0.5 * step;
    beyond += correlation.pp(middle) * 24 * phi * middle * middle * step;
    if (beyond > negligible) break;
  }
  return d;
}

/// Every sphere's neighbours within the cutoff.
std::vector<SphereRow> sphere_rows(const LocalCorrelation& correlation, const SolidFractionField& field,
                                   const Enclosure& enclosure, const std::vector<double>& area) {
  const std::size_t n = enclosure.sphere_count();
  const double cutoff_m = correlation.cutoff() * mean_diameter_m(enclosure.radius_m) * 1.01;
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  const CellGrid grid(enclosure.centre_m, all, cutoff_m, enclosure.box, enclosure.periodic);
  std::vector<SphereRow> rows(n);
#pragma omp parallel
  {
    std::vector<std::pair<std::int32_t, double>> found;
#pragma omp for schedule(dynamic, 64)
    for (std::size_t i = 0; i < n; ++i) {
      found.clear();
      const Vec3 centre = enclosure.centre_m[i];
      grid.visit_around(centre, [&](std::int32_t j, const Vec3& p) {
        if (static_cast<std::size_t>(j) == i) return;
        const double d_star = norm(p - centre) / (enclosure.radius_m[i] + enclosure.radius_m[j]);
        if (d_star >= correlation.cutoff()) return;
        const double factor = correlation.pp(d_star, field.at(0.5 * (p + centre)));
        if (factor > 0) found.emplace_back(j, 0.5 * (area[i] + area[j]) * factor);
      });
      std::sort(found.begin(), found.end());
      for (const auto& [j, x] : found) rows[i].add(j, x);
    }
  }
  return rows;
}

/// Unobstructed factors [wall][sphere].
std::vector<std::vector<double>> unobstructed_factors(const Enclosure& enclosure) {
  std::vector<std::vector<double>> factors;
  for (const auto& wall : enclosure.walls) {
    auto& column = factors.emplace_back(enclosure.sphere_count());
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < column.size(); ++i)
      column[i] = exact_sphere_wall(enclosure.centre_m[i], wall);
  }
  return factors;
}

/// Walls of one plane: a patch and the wall it lies on, zones side by side. A table knows the whole plane.
std::vector<std::vector<std::size_t>> walls_by_plane(const Enclosure& enclosure) {
  constexpr double same = 1e-6;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    const auto plane = plane_of(enclosure.walls[w]);
    const double size_m = std::sqrt(area(enclosure.walls[w]));
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      const Wall& other = enclosure.walls[group.front()];
      return dot(plane_of(other)->normal, plane->normal) > 1 - same &&
             std::abs(plane->height(other.vertices[0])) < same * (size_m + std::sqrt(area(other)));
    });
    if (found == groups.end())
      groups.push_back({w});
    else
      found->push_back(w);
  }
  return groups;
}

/// X of each sphere and wall [wall][sphere] from the table: of all walls in one plane together, and each its part by what
/// it would be given without the bed.
std::vector<std::vector<double>> table_walls(const LocalCorrelation& correlation,
                                             const SolidFractionField& field, const Enclosure& enclosure,
                                             const std::vector<double>& area,
                                             const std::vector<std::vector<double>>& exact) {
  std::vector<std::vector<double>> x(enclosure.walls.size(), std::vector<double>(enclosure.sphere_count()));
  for (const auto& group : walls_by_plane(enclosure)) {
    const Wall& wall = enclosure.walls[group.front()];
    const Vec3 normal = plane_of(wall)->normal;
    for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
      const Vec3 centre = enclosure.centre_m[i];
      const double height = dot(centre - wall.vertices[0], normal);
      const double phi = field.uniform() ? field.whole() : field.between(centre, centre - normal * height);
      double unobstructed = 0;
      for (const auto w : group) unobstructed += exact[w][i];
      if (!(unobstructed > 0)) continue;
      const double factor = correlation.pw(height / (2 * enclosure.radius_m[i]), unobstructed, phi);
      for (const auto w : group) x[w][i] = area[i] * factor * (exact[w][i] / unobstructed);
    }
  }
  return x;
}

/// Sphere-wall entries; columns of the walls follow those of the spheres.
void add_walls(const std::vector<std::vector<double>>& x, std::size_t spheres, std::vector<SphereRow>& rows) {
  for (std::size_t w = 0; w < x.size(); ++w)
    for (std::size_t i = 0; i < spheres; ++i) {
      if (!(x[w][i] > 0)) continue;
      rows[i].add(spheres + w, x[w][i]);
      rows[spheres + w].add(i, x[w][i]);
    }
}

void add_wall_pairs(std::size_t first_wall, const WallExchange& walls, std::vector<SphereRow>& rows) {
  for (std::size_t w = 0; w < walls.walls; ++w)
    for (std::size_t v = 0; v < walls.walls; ++v)
      if (const double x = walls.value[w * walls.walls + v]; x > 0)
        rows[first_wall + w].add(first_wall + v, x);
}

/// Rows of walls or their patches by their own rays, each pair of them from both ends: rays in proportion to area, so that
/// both ends know as much. Returns what fraction of the view of each leaves.
std::vector<double> add_traced_walls(const HitCounts& counts, std::size_t spheres,
                                     std::vector<SphereRow>& rows) {
  const std::size_t open = counts.area_m2.size() - 1;
  std::vector<double> opening(open - spheres, 0);
  for (std::size_t w = spheres; w < open; ++w)
    for (auto k = counts.pattern.row_begin[w]; k < counts.pattern.row_begin[w + 1]; ++k) {
      const auto j = static_cast<std::size_t>(counts.pattern.column[k]);
      const double seen = static_cast<double>(counts.hits[k]) / static_cast<double>(counts.launched[w]);
      const double x = counts.area_m2[w] * seen * (j < spheres || j == w ? 1 : 0.5);
      if (j == open) {
        opening[w - spheres] = seen;
        continue;
      }
      rows[w].add(j, x);
      if (j != w) rows[j].add(w, x);
    }
  for (std::size_t w = spheres; w < open; ++w) rows[w].sort();
  return opening;
}

/// Surfaces that see an opening give it what is missing to their area.
void add_surroundings(const Enclosure& enclosure, const std::vector<double>& area,
                      const std::vector<std::vector<double>>& exact, const std::vector<double>& openings,
                      std::vector<SphereRow>& rows) {
  const std::size_t n = enclosure.sphere_count(), open = enclosure.open_surface();
  for (std::size_t i = 0; i < open; ++i) {
    double opening = 1;
    if (i >= n)
      opening = openings[i - n];
    else
      for (const auto& column : exact) opening -= column[i];
    const double missing = area[i] - rows[i].sum();
    if (opening < 1e-6 || missing <= 0) continue;
    rows[i].add(open, missing);
    rows[open].add(i, missing);
  }
}

ExchangeAreas flattened(const std::vector<SphereRow>& rows, std::vector<double> area) {
  ExchangeAreas areas;
  areas.area_m2 = std::move(area);
  areas.pattern.row_begin.push_back(0);
  for (const auto& row : rows) {
    areas.pattern.column.insert(areas.pattern.column.end(), row.column.begin(), row.column.end());
    areas.value.insert(areas.value.end(), row.value.begin(), row.value.end());
    areas.pattern.row_begin.push_back(static_cast<std::int64_t>(areas.value.size()));
  }
  return areas;
}

/// What a table cannot serve although its range would do: most of the bed is denser than the mean tells.
void require_local_solid_fractions(const CorrelationTable& table, const SolidFractionField& field) {
  require_solid_fraction(table, field.whole(), "the bed");
  if (!field.uniform())
    require_solid_fraction(table, field.mean_at_spheres(), "the part of the box the particles fill");
}

/// Of the walls' rays each sphere must be due some: they tell what it exchanges with the walls.
void require_rays_for_spheres(const Enclosure& enclosure, double rays) {
  constexpr double fewest = 10;
  const auto area = surface_areas(enclosure);
  const auto wall = area.begin() + static_cast<std::ptrdiff_t>(enclosure.sphere_count());
  const double of_walls = std::accumulate(wall, area.end(), 0.0);
  if (enclosure.sphere_count() == 0 || of_walls == 0) return;
  const double mean =
      std::accumulate(area.begin(), wall, 0.0) / static_cast<double>(enclosure.sphere_count());
  if (const double due = rays * mean / of_walls; due < fewest)
    throw InputError(advised(
        fmt::format(
            "correlation: {:.2g} of the walls' {:.2g} rays would meet a sphere (the walls are {:.2g} times as "
            "wide as one)",
            due, rays, of_walls / mean),
        "take the walls from the table (radiation.wall_rows = \"table\"), or source = paths or embree"));
}

/// Adds the rows of the walls, and what spheres exchange with them, by rays. Returns their openings.
std::vector<double> trace_walls(const PatchRays& walls, const Enclosure& enclosure, const CorrelationUse& use,
                                std::uint64_t update, std::vector<SphereRow>& rows) {
  const double rays = use.wall_rays * std::max<double>(1000, static_cast<double>(enclosure.sphere_count()));
  require_rays_for_spheres(enclosure, rays);
  return add_traced_walls(walls.trace_walls(rays, use.seed + update, use.threads), enclosure.sphere_count(),
                          rows);
}

}  // namespace

ExchangeAreas correlation_exchange_areas(const CorrelationTable& table, const Enclosure& enclosure,
                                         const CorrelationUse& use, std::uint64_t update,
                                         CorrelationUsed* used) {
  refuse_what_a_table_cannot_serve(table, enclosure);
  const std::size_t n = enclosure.sphere_count();
  const bool traced = use.wall_rows == WallRows::traced;
  std::optional<PatchRays> walls;
  if (traced) walls.emplace(enclosure, use.patches, use.threads);
  const Enclosure& surfaces = walls ? walls->surfaces() : enclosure;
  const auto area = surface_areas(surfaces);
  const double whole = n == 0 ? 0 : use.solid_fraction > 0 ? use.solid_fraction : solid_fraction(enclosure);
  const SolidFractionField field =
      use.uniform ? SolidFractionField(whole) : SolidFractionField(enclosure, whole);
  require_local_solid_fractions(table, field);
  const auto exact = unobstructed_factors(enclosure);
  std::vector<SphereRow> rows;
  if (n > 0) {
    const double farthest = field.uniform() ? farthest_that_counts(table, whole) : table.pp_cutoff;
    const LocalCorrelation correlation(table, field, farthest);
    rows = sphere_rows(correlation, field, enclosure, area);
    rows.resize(surfaces.surface_count());
    if (!traced) add_walls(table_walls(correlation, field, enclosure, area, exact), n, rows);
    if (used) *used = {whole, field.deviation(), !field.uniform(), farthest};
  }
  rows.resize(surfaces.surface_count());
  if (traced) {
    add_surroundings(surfaces, area, exact, trace_walls(*walls, enclosure, use, update, rows), rows);
  } else {
    const auto between = wall_exchange(enclosure, field, n == 0 ? 1 : mean_diameter_m(enclosure.radius_m));
    add_wall_pairs(n, between, rows);
    add_surroundings(enclosure, area, exact, between.opening, rows);
  }
  return flattened(rows, area);
}

std::function<ExchangeAreas(const Enclosure&, std::uint64_t)> correlation_exchange(CorrelationTable table,
                                                                                   CorrelationUse use) {
  return [table = std::move(table), use](const Enclosure& enclosure, std::uint64_t update) {
    return correlation_exchange_areas(table, enclosure, use, update);
  };
}

}  // namespace granrad
