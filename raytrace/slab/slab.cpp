#include "raytrace/slab/slab.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

constexpr int columns = 4;
constexpr double least_diameters = 8;
constexpr const char* plate_names[3][2] = {{"x_min", "x_max"}, {"y_min", "y_max"}, {"z_min", "z_max"}};

std::int32_t find_plate(const Enclosure& enclosure, const char* name) {
  for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
    if (enclosure.walls[w].name == name && plane_of(enclosure.walls[w]))
      return static_cast<std::int32_t>(enclosure.sphere_count() + w);
  throw InputError(
      advised(fmt::format("there is no wall {} to be a plate", name), "give the box its walls there"));
}

/// Which quarter of the section a sphere is in, by the median of each direction.
std::vector<int> quarter_columns(const std::vector<Vec3>& centres, int axis) {
  const auto median = [&](int k) {
    std::vector<double> values;
    for (const Vec3& p : centres) values.push_back(p[k]);
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double mu = median(u), mv = median(v);
  std::vector<int> column;
  for (const Vec3& p : centres) column.push_back(2 * (p[u] >= mu) + (p[v] >= mv));
  return column;
}

/// The middle half of one column (-1: all).
BulkLine fit(const Slab& slab, const std::vector<double>& u, int column) {
  double n = 0, sz = 0, su = 0, szz = 0, szu = 0;
  const double middle = 0.5 * (slab.low_m + slab.high_m);
  for (std::size_t k = 0; k < slab.spheres(); ++k) {
    const double z = slab.z_m[k] - middle;
    if (slab.z_m[k] < slab.from_m() || slab.z_m[k] > slab.to_m() || !std::isfinite(u[k])) continue;
    if (column >= 0 && slab.column[k] != column) continue;
    n += 1, sz += z, su += u[k], szz += z * z, szu += z * u[k];
  }
  BulkLine line;
  line.slope_per_m = (n * szu - sz * su) / (n * szz - sz * sz);
  const double at_middle = (su - line.slope_per_m * sz) / n, half = 0.5 * slab.distance_m();
  line.at_low = at_middle - line.slope_per_m * half;
  line.at_high = at_middle + line.slope_per_m * half;
  return line;
}

}  // namespace

double Slab::solid_fraction() const {
  double volume = 0;
  for (std::size_t k = 0; k < spheres(); ++k)
    if (z_m[k] >= from_m() && z_m[k] <= to_m()) volume += 4 * pi / 3 * std::pow(enclosure.radius_m[k], 3);
  return volume / (area_m2 * (to_m() - from_m()));
}

Slab make_slab(Enclosure enclosure, int axis) {
  Slab slab;
  for (std::size_t side = 0; side < 2; ++side)
    slab.plate[side] = find_plate(enclosure, plate_names[axis][side]);
  if (enclosure.sphere_count() == 0) throw InputError("there are no particles between the plates");
  const auto wall = [&](int side) { return enclosure.walls[slab.plate[side] - enclosure.sphere_count()]; };
  slab.low_m = wall(0).vertices[0][axis];
  slab.high_m = wall(1).vertices[0][axis];
  slab.area_m2 = area(wall(0));
  for (const Vec3& p : enclosure.centre_m) slab.z_m.push_back(p[axis]);
  slab.z_m.push_back(slab.low_m);
  slab.z_m.push_back(slab.high_m);
  slab.column = quarter_columns(enclosure.centre_m, axis);
  for (double r : enclosure.radius_m)
    slab.diameter_m += 2 * r / static_cast<double>(enclosure.sphere_count());
  slab.enclosure = std::move(enclosure);
  if (slab.distance_m() < least_diameters * slab.diameter_m)
    throw InputError(
        advised(fmt::format("{:.1f} diameters lie between the plates", slab.distance_m() / slab.diameter_m),
                fmt::format("a bulk needs {:g}: make the box longer", least_diameters)));
  return slab;
}

double flux(const Slab& slab, const std::vector<Link>& links, const std::vector<double>& u, double from_m,
            double to_m) {
  double sum = 0;
  for (const Link& link : links) {
    if (!std::isfinite(u[link.a]) || !std::isfinite(u[link.b])) continue;
    const double a = slab.z_m[link.a], b = slab.z_m[link.b];
    const double inside = std::min(std::max(a, b), to_m) - std::max(std::min(a, b), from_m);
    if (inside > 0) sum += (b > a ? 1 : -1) * link.conductance * (u[link.a] - u[link.b]) * inside;
  }
  return sum / (slab.area_m2 * (to_m - from_m));
}

BulkLine bulk_line(const Slab& slab, const std::vector<double>& u) {
  BulkLine line = fit(slab, u, -1);
  double squares = 0, sum = 0;
  std::array<double, columns> slope{};
  for (int c = 0; c < columns; ++c) sum += slope[c] = fit(slab, u, c).slope_per_m;
  for (double one : slope) squares += (one - sum / columns) * (one - sum / columns);
  line.slope_error_per_m = std::sqrt(squares / (columns * (columns - 1)));
  return line;
}

std::vector<double> slab_potentials(const Slab& slab, const std::vector<Link>& links) {
  auto u = steady_potentials(slab.spheres(), links);
  u.push_back(1);
  u.push_back(0);
  return u;
}

std::vector<Link> radiation_links(const Slab& slab, const std::vector<double>& emissivity,
                                  const TraceOptions& options, std::int64_t& rays) {
  const auto n = static_cast<std::int32_t>(slab.spheres());
  const auto surfaces = static_cast<std::int32_t>(slab.enclosure.surface_count());
  const auto node = [&](std::int32_t surface) {
    return surface < n ? surface : surface == slab.plate[0] ? n : surface == slab.plate[1] ? n + 1 : -1;
  };
  TraceReport report;
  const auto counts = trace_total_exchange(slab.enclosure, emissivity, options, &report);
  rays += report.rays;
  ClosureReport closed;
  const auto areas = close(one_way_estimate(counts), Closure::reciprocal, closed);
  std::vector<Link> links;
  for (std::int32_t i = 0; i < surfaces; ++i)
    for (auto k = areas.pattern.row_begin[i]; k < areas.pattern.row_begin[i + 1]; ++k) {
      const auto j = areas.pattern.column[k];
      if (i < j && node(i) >= 0 && node(j) >= 0 && areas.value[k] > 0)
        links.push_back({node(i), node(j), areas.value[k]});
    }
  return links;
}

SlabRadiation radiation_between_plates(const Slab& slab, const std::vector<Link>& links) {
  const auto e = slab_potentials(slab, links);
  const BulkLine line = bulk_line(slab, e);
  return {flux(slab, links, e, slab.from_m(), slab.to_m()) / (-line.slope_per_m * slab.diameter_m),
          std::abs(line.slope_error_per_m / line.slope_per_m), flux(slab, links, e, slab.low_m, slab.high_m)};
}

ExchangeFactor measure_exchange_factor(const Slab& slab, const std::vector<double>& emissivity,
                                       const TraceOptions& options, int replicates) {
  ExchangeFactor result;
  std::vector<SlabRadiation> all;
  double bed = 0;
  const auto n = static_cast<double>(replicates);
  for (int k = 0; k < replicates; ++k) {
    TraceOptions one = options;
    one.seed += 7919 * static_cast<std::uint64_t>(k);
    all.push_back(radiation_between_plates(slab, radiation_links(slab, emissivity, one, result.rays)));
    result.factor.value += all.back().exchange_factor / n;
    result.flux.value += all.back().flux / n;
    bed += all.back().factor_bed_error / n;
  }
  double factor = 0, flux = 0;
  for (const auto& r : all) {
    factor += std::pow(r.exchange_factor - result.factor.value, 2);
    flux += std::pow(r.flux - result.flux.value, 2);
  }
  result.factor.error = std::hypot(std::sqrt(factor / (n * (n - 1))), bed * result.factor.value);
  result.flux.error = std::sqrt(flux / (n * (n - 1)));
  return result;
}

}  // namespace granrad
