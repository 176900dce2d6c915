#include "fit/correlation/correlation_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/cell_grid.h"
#include "fit/correlation/wall_exchange.h"
#include "raytrace/exact.h"
#include "raytrace/facets.h"

namespace granrad {

namespace {

/// Entries of one row in ascending columns.
struct Row {
  std::vector<std::int32_t> column;
  std::vector<double> value;
  void add(std::size_t c, double x) {
    column.push_back(static_cast<std::int32_t>(c));
    value.push_back(x);
  }
  double sum() const { return std::accumulate(value.begin(), value.end(), 0.0); }
};

void refuse_what_a_table_cannot_serve(const CorrelationTable& table, const Enclosure& enclosure) {
  std::vector<std::string> problems;
  if (!enclosure.radius_m.empty()) {
    const auto [low, high] = std::minmax_element(enclosure.radius_m.begin(), enclosure.radius_m.end());
    if (*high > 1.01 * *low)
      problems.push_back(
          fmt::format("{}: radii = {:.4g} to {:.4g} m (correlations hold for equal spheres, within "
                      "1 %) trace view factors instead",
                      table.name, *low, *high));
  }
  for (const auto& wall : enclosure.walls)
    if (!wall.is_polygon())
      problems.push_back(
          fmt::format("{}: wall {} is a mesh (correlations hold for planar walls) trace view "
                      "factors instead",
                      table.name, wall.name));
  for (int axis = 0; axis < 3; ++axis)
    if (enclosure.periodic[axis])
      problems.push_back(
          fmt::format("{}: the box is periodic in {} (correlations need walls) trace view factors "
                      "instead",
                      table.name, "xyz"[axis]));
  if (!problems.empty()) throw InputError(problems);
}

/// Every sphere's neighbours within the cutoff.
std::vector<Row> sphere_rows(const Correlation& correlation, const Enclosure& enclosure,
                             const std::vector<double>& area) {
  const std::size_t n = enclosure.sphere_count();
  const double cutoff_m = correlation.pp_cutoff() * mean_diameter_m(enclosure.radius_m) * 1.01;
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  const CellGrid grid(enclosure.centre_m, all, cutoff_m, enclosure.box, enclosure.periodic);
  std::vector<Row> rows(n);
#pragma omp parallel
  {
    std::vector<std::pair<std::int32_t, double>> found;
#pragma omp for schedule(dynamic, 64)
    for (std::size_t i = 0; i < n; ++i) {
      found.clear();
      grid.visit_around(enclosure.centre_m[i], [&](std::int32_t j, const Vec3& p) {
        if (static_cast<std::size_t>(j) == i) return;
        const double d_star =
            norm(p - enclosure.centre_m[i]) / (enclosure.radius_m[i] + enclosure.radius_m[j]);
        const double factor = correlation.pp(d_star);
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
      column[i] = exact_sphere_polygon(enclosure.centre_m[i], wall);
  }
  return factors;
}

/// Sphere-wall entries; columns of the walls follow those of the spheres.
void add_walls(const Correlation& correlation, const Enclosure& enclosure, const std::vector<double>& area,
               const std::vector<std::vector<double>>& exact, std::vector<Row>& rows) {
  const std::size_t n = enclosure.sphere_count();
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
    const Wall& wall = enclosure.walls[w];
    const Vec3 normal = polygon_normal(wall);
    for (std::size_t i = 0; i < n; ++i) {
      const double h_over_d =
          dot(enclosure.centre_m[i] - wall.vertices[0], normal) / (2 * enclosure.radius_m[i]);
      const double x = area[i] * correlation.pw(h_over_d, exact[w][i]);
      if (!(x > 0)) continue;
      rows[i].add(n + w, x);
      rows[n + w].add(i, x);
    }
  }
}

void add_wall_pairs(std::size_t first_wall, const WallExchange& walls, std::vector<Row>& rows) {
  for (std::size_t w = 0; w < walls.walls; ++w)
    for (std::size_t v = 0; v < walls.walls; ++v)
      if (const double x = walls.value[w * walls.walls + v]; x > 0)
        rows[first_wall + w].add(first_wall + v, x);
}

/// Surfaces that see an opening give it what is missing to their area.
void add_surroundings(const Enclosure& enclosure, const std::vector<double>& area,
                      const std::vector<std::vector<double>>& exact, const WallExchange& walls,
                      std::vector<Row>& rows) {
  const std::size_t n = enclosure.sphere_count(), open = enclosure.open_surface();
  for (std::size_t i = 0; i < open; ++i) {
    double opening = 1;
    if (i >= n)
      opening = walls.opening[i - n];
    else
      for (const auto& column : exact) opening -= column[i];
    const double missing = area[i] - rows[i].sum();
    if (opening < 1e-6 || missing <= 0) continue;
    rows[i].add(open, missing);
    rows[open].add(i, missing);
  }
}

ExchangeAreas flattened(const std::vector<Row>& rows, std::vector<double> area) {
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

}  // namespace

double solid_fraction(const Enclosure& enclosure) {
  Facets facets(0);
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), {}, 1);
  const auto volume = facets.enclosed_volume({});
  if (!volume || !(*volume > 0))
    throw InputError(
        "the walls do not enclose a volume (the solid fraction of the bed cannot be measured) close the box "
        "with "
        "walls, or give the solid fraction");
  double solid = 0;
  for (const double r : enclosure.radius_m) solid += sphere_volume(r);
  return solid / *volume;
}

ExchangeAreas correlation_exchange_areas(const CorrelationTable& table, const Enclosure& enclosure,
                                         double solid_fraction) {
  refuse_what_a_table_cannot_serve(table, enclosure);
  const auto area = surface_areas(enclosure);
  const bool empty = enclosure.sphere_count() == 0;
  std::vector<Row> rows;
  const auto exact = unobstructed_factors(enclosure);
  const auto walls = wall_exchange(
      enclosure, empty ? 0 : extinction_1_m(solid_fraction, mean_diameter_m(enclosure.radius_m)));
  if (empty) {
    rows.resize(enclosure.surface_count());
    add_wall_pairs(0, walls, rows);
  } else {
    const Correlation correlation(table, solid_fraction);
    rows = sphere_rows(correlation, enclosure, area);
    rows.resize(enclosure.surface_count());
    add_walls(correlation, enclosure, area, exact, rows);
    add_wall_pairs(enclosure.sphere_count(), walls, rows);
  }
  add_surroundings(enclosure, area, exact, walls, rows);
  return flattened(rows, area);
}

std::function<ExchangeAreas(const Enclosure&, std::uint64_t)> correlation_exchange(
    CorrelationTable table, double fixed_solid_fraction) {
  return [table = std::move(table), fixed_solid_fraction](const Enclosure& enclosure, std::uint64_t) {
    const double phi = fixed_solid_fraction > 0 || enclosure.sphere_count() == 0 ? fixed_solid_fraction
                                                                                 : solid_fraction(enclosure);
    return correlation_exchange_areas(table, enclosure, phi);
  };
}

}  // namespace granrad
